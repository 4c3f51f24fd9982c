#include "files/picture_roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <utility>

#include "dermis/error.hpp"
#include "files/renderer_file.hpp"

namespace dermis::program {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The last number in the name of a file, as it is written; empty if there is none.
std::string number_of(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  const auto first = std::find_if_not(last, stem.rend(), is_digit);
  return {first.base(), last.base()};
}

/// The place of a number in a text: "####" or "%04d", and how many digits it has at least.
struct NumberPlace {
  std::size_t at;
  std::size_t size;
  std::size_t digits;
};

std::optional<NumberPlace> place_in(std::string_view text) {
  if (const std::size_t at = text.find('#'); at != std::string_view::npos) {
    const std::size_t size = std::min(text.find_first_not_of('#', at), text.size()) - at;
    return NumberPlace{at, size, size};
  }
  const std::size_t at = text.find('%');
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t end = text.find_first_not_of("0123456789", at + 1);
  if (end == std::string_view::npos || text[end] != 'd' || end > at + 3) return std::nullopt;
  const std::string digits(text.substr(at + 1, end - at - 1));
  return NumberPlace{at, end + 1 - at, digits.empty() ? 1 : std::stoul(digits)};
}

}  // namespace

std::string with_frame_number(std::string_view argument, const std::string& text, const std::string& path) {
  std::string out = text;
  while (const std::optional<NumberPlace> place = place_in(out)) {
    std::string number = number_of(path);
    if (number.empty())
      throw Error(ErrorCode::usage, argument, fmt::format("{} for {}, which has no number", text, path),
                  "a picture with the number of a frame in its name");
    number.erase(0, std::min(number.find_first_not_of('0'), number.size() - 1));
    if (number.size() < place->digits) number.insert(0, place->digits - number.size(), '0');
    out.replace(place->at, place->size, number);
  }
  return out;
}

std::vector<std::string> views_of(const exr::Picture& picture, const PictureArguments& arguments) {
  std::vector<std::string> views = picture.views();
  if (arguments.eye.empty()) return views.empty() ? std::vector<std::string>{""} : views;
  if (std::find(views.begin(), views.end(), arguments.eye) == views.end())
    throw Error(ErrorCode::role_missing, "--eye", arguments.eye,
                views.empty() ? "no view, for the picture has none" : fmt::format("one of {}", fmt::join(views, ", ")));
  return {arguments.eye};
}

exr::Roles roles_of(exr::Picture& picture, const std::string& path, const PictureArguments& arguments,
                    const std::string& view) {
  exr::RoleRequest request{.overrides = {}, .layer = arguments.layer, .view = view};
  for (const std::string& text : arguments.roles) {
    // Names of channels may hold a # or a %; names of other files have the number of the frame in its place.
    const std::vector<std::string> files = exr::files_of({&text, 1});
    request.overrides.push_back(files.empty() ? text : with_frame_number("--role", text, path));
  }
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
