#include "files/picture_roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "dermis/error.hpp"
#include "files/renderer_file.hpp"

namespace dermis::program {

std::vector<std::string> views_of(const exr::Picture& picture, const PictureArguments& arguments) {
  std::vector<std::string> views = picture.views();
  if (arguments.eye.empty()) return views.empty() ? std::vector<std::string>{""} : views;
  if (std::find(views.begin(), views.end(), arguments.eye) == views.end())
    throw Error(ErrorCode::role_missing, "--eye", arguments.eye,
                views.empty() ? "no view, for the picture has none" : fmt::format("one of {}", fmt::join(views, ", ")));
  return {arguments.eye};
}

std::vector<std::string> role_texts(const PictureArguments& arguments, const FrameFile& frame) {
  std::vector<std::string> texts = arguments.roles;
  for (std::string& text : texts) {
    // Names of channels may hold a # or a %.
    for (const std::string& file : exr::files_of({&text, 1})) {
      const std::string its = with_frame_number("--role", file, frame);
      for (std::size_t at = text.find(file); at != std::string::npos; at = text.find(file, at + its.size()))
        text.replace(at, file.size(), its);
    }
  }
  return texts;
}

exr::Roles roles_of(exr::Picture& picture, const FrameFile& frame, const PictureArguments& arguments,
                    const std::string& view) {
  exr::RoleRequest request{.overrides = role_texts(arguments, frame), .layer = arguments.layer, .view = view};
  std::vector<std::string> warnings;
  for (const std::string& file : exr::files_of(request.overrides))
    if (std::string warning = picture.join(file); !warning.empty()) warnings.push_back(std::move(warning));
  const std::optional<exr::Renderer> own = read_renderer(arguments.preset);
  request.renderer = own ? &*own : exr::find_renderer(arguments.preset);
  exr::Roles roles = exr::find_roles(picture, request);
  roles.warnings = std::move(warnings);
  return roles;
}

}  // namespace dermis::program
