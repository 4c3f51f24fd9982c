#include "files/loaded_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string_view>

#include "files/picture_roles.hpp"
#include "files/view_factor.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// Renderers write 0 where there is nothing: such a position counts as none.
void forget_background(std::vector<float>& position, const std::vector<float>& normal) {
  for (std::size_t i = 0; i < position.size(); i += 3) {
    const bool has_normal = normal[i] != 0 || normal[i + 1] != 0 || normal[i + 2] != 0;
    if (!has_normal) position[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

LoadedView load_view(const SurfaceRequest& request, const std::string& path, Lighting lighting) {
  exr::Picture picture = exr::Picture::read(path);
  // Channels and camera that the command line names are those of the picture itself.
  PictureArguments names;
  names.preset = request.picture.preset;
  const exr::Roles roles = roles_of(picture, frame_file(path), names);
  std::vector<Role> needed = {Role::light, Role::albedo, Role::position, Role::normal};
  if (have_ids(request.profiles) && request.mattes.empty()) needed.push_back(Role::material);
  for (const Role role : needed)
    if (!roles.has(role))
      throw Error(ErrorCode::role_missing, fmt::format("--view {}", path), fmt::format("no {}", exr::name_of(role)),
                  fmt::format("a pass of {}", exr::info_of(role).what));
  if (!request.lighting && roles.lighting != lighting)
    throw Error(ErrorCode::input_unsupported, fmt::format("--view {}", path),
                fmt::format("light that is {}", name_of(roles.lighting)),
                fmt::format("{} as that of the picture, or --lighting", name_of(lighting)));
  LoadedView view{path,
                  load_images(picture, roles, request.profiles, request.mattes, folder_of(path)),
                  exr::load(picture, roles, Role::position),
                  exr::load(picture, roles, Role::normal),
                  {}};
  if (takes_out_view_factor(request, roles))
    take_out(view_factors(picture, roles, exr::find_camera(picture, roles)), view.images.light);
  forget_background(view.position, view.normal);
  return view;
}

}  // namespace

View LoadedView::view() const {
  return {.width = images.width,
          .height = images.height,
          .light = image_of(images.light),
          .albedo = image_of(images.albedo),
          .position = image_of(position),
          .normal = image_of(normal),
          .material = image_of(images.material),
          .to_camera = to_camera};
}

bool takes_out_view_factor(const SurfaceRequest& request, const exr::Roles& roles) {
  if (request.view_factor != ViewFactor::automatic) return request.view_factor == ViewFactor::principled;
  return (!request.views.empty() || any_walk(request.profiles)) && roles.renderer == "blender" &&
         roles.has(exr::Role::normal) && roles.has(exr::Role::position);
}

std::vector<LoadedView> load_views(const SurfaceRequest& request, const FrameFile& frame,
                                   const exr::FoundCamera& camera, Lighting lighting) {
  std::vector<LoadedView> views;
  for (const std::string& name : request.views) {
    if (!camera.world_to_camera)
      throw Error(ErrorCode::role_missing, "--view", fmt::format("{} with a camera from {}", name, camera.source),
                  "a picture with positions that tell where its camera is");
    views.push_back(load_view(request, with_frame_number("--view", name, frame), lighting));
    views.back().to_camera = *camera.world_to_camera;
  }
  return views;
}

Error view_named_by_file(const Error& error, const std::vector<LoadedView>& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (error.argument() == fmt::format("view {}", i + 1))
      return {error.code(), fmt::format("--view {}", views[i].path), error.seen(), error.wanted()};
  }
  return error;
}

void report_views(const std::vector<LoadedView>& views, const Stats& stats, Messages& messages) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto& [seen, hidden, contradicting] = stats.views[i];
    messages.input(fmt::format("--view {}: {} pixels of surface that the camera does not see, {} that it does",
                               views[i].path, hidden, seen));
  }
  if (!views.empty() && stats.pixels_reached == 0)
    messages.warn(ErrorCode::input_unsupported, "--view",
                  "no surface that only a view shows is within reach of any pixel: nothing is added; want a view from "
                  "behind, or another --mm-per-unit");
}

}  // namespace dermis::program
