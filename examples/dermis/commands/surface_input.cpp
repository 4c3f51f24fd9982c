#include "commands/surface_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <set>

#include "dermis/error.hpp"
#include "exr/memory_limit.hpp"
#include "exr/message_text.hpp"
#include "files/picture_roles.hpp"
#include "files/surface_pixels.hpp"
#include "files/view_factor.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// Throws Error(role_missing) if the picture lacks a role that is needed.
TranslucencyImages load_translucency_images(const exr::Picture& picture, const exr::Roles& roles) {
  for (const Role role : {Role::position, Role::normal, Role::albedo}) exr::require(picture, roles, role);
  return {exr::load(picture, roles, Role::position), exr::load(picture, roles, Role::normal),
          exr::load(picture, roles, Role::thickness)};
}

/// Where something scatters, for other pixels keep their light.
void take_out_view_factor(SurfaceInput& input, const std::vector<NamedProfile>& profiles) {
  input.view_factors = view_factors(input.picture, input.roles, input.camera);
  const std::vector<std::uint8_t> scatters = scattering_pixels(input.loaded, profiles);
  for (std::size_t i = 0; i < scatters.size(); ++i)
    if (scatters[i] == 0) input.view_factors[i] = 1;
  take_out(input.view_factors, input.loaded.light);
}

}  // namespace

Frame SurfaceInput::frame(double mm_per_unit) const {
  Frame frame = loaded.frame();
  frame.camera = camera.camera;
  frame.mm_per_unit = mm_per_unit;
  frame.views = views;
  return frame;
}

exr::Picture read_picture(const std::string& path) {
  constexpr std::size_t added_channels = 3;  // of one view
  exr::Picture picture = exr::Picture::read(path, added_channels);
  // The images that are scattered, what surrounds them and what is made of them take about as much again.
  std::uint64_t pixel_bytes = 0;
  for (const exr::Channel& channel : picture.channels()) pixel_bytes += bytes_of(channel.format);
  exr::require_memory(exr::escaped(path), pixel_bytes * static_cast<std::uint64_t>(picture.width()) *
                                              static_cast<std::uint64_t>(picture.height()));
  return picture;
}

SurfaceInput load_surface(exr::Picture& picture, const FrameFile& frame, const std::string& view,
                          const SurfaceRequest& request, bool needs_beauty) {
  SurfaceInput input{picture, roles_of(picture, frame, request.picture, view), {}, {}, {}, {}, {}, {}, {}, true};
  input.lighting = request.lighting.value_or(input.roles.lighting);
  require_roles(picture, input.roles, request.profiles, !request.mattes.empty());
  if (needs_beauty) exr::require(picture, input.roles, Role::beauty);
  // The camera takes as long to find as the images take to load, and needs none of them.
  auto camera =
      std::async(std::launch::async, [&] { return exr::find_camera(picture, input.roles, request.picture.camera); });
  input.loaded = load_images(picture, input.roles, request.profiles, request.mattes, folder_of(frame.path));
  const auto scatters = [&] {
    const std::vector<std::uint8_t> pixels = scattering_pixels(input.loaded, request.profiles);
    return std::find(pixels.begin(), pixels.end(), 1) != pixels.end();
  };
  try {
    input.camera = camera.get();
    input.loaded.depth = load_depth_image(picture, input.roles, input.camera);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::role_missing) throw;
    input.loaded.depth = load_depth_image(picture, input.roles);
    if (scatters()) throw;
    input.camera.source = "none, as nothing scatters";
  }
  input.scatters = scatters();
  if (input.scatters && request.curvature && any_walk(request.profiles))
    input.loaded.normal = load_normal_image(picture, input.roles, input.camera);
  const bool is_asked = request.view_factor != ViewFactor::automatic;
  if (input.scatters && takes_out_view_factor(request, input.roles) && (is_asked || input.camera.eye))
    take_out_view_factor(input, request.profiles);
  if (input.scatters) input.loaded_views = load_views(request, frame, input.camera, input.lighting);
  for (const LoadedView& loaded : input.loaded_views) input.views.push_back(loaded.view());
  if (request.lights) input.translucency = load_translucency_images(picture, input.roles);
  return input;
}

std::vector<std::string> pictures_read(const SurfaceRequest& request, const FrameFile& frame) {
  std::vector<std::string> files = exr::files_of(role_texts(request.picture, frame));
  files.insert(files.begin(), frame.path);
  for (const std::string& view : request.views) files.push_back(with_frame_number("--view", view, frame));
  return files;
}

std::vector<MaterialPixels> count_pixels(const SurfaceInput& input, const SurfaceRequest& request, Messages& messages) {
  const MaterialCounts counts = count_materials(input.loaded.material, input.loaded.depth);
  std::vector<MaterialPixels> all;
  for (const NamedProfile& named : request.profiles) {
    SurfacePixels pixels;
    if (!named.id) {
      pixels = count_surface(input.loaded.depth, input.loaded.mask);
    } else if (const auto found = counts.by_id.find(*named.id); found != counts.by_id.end()) {
      pixels = found->second;
    } else {
      messages.warn(ErrorCode::role_missing, option_text(named), "no pixel is of this material");
    }
    const Camera& camera = input.camera.camera;
    all.push_back({pixels.pixels, pixel_mm_at(pixels.median_depth_units, camera, request.mm_per_unit),
                   pixel_mm_at(pixels.nearest_depth_units, camera, request.mm_per_unit)});
  }
  return all;
}

void require_scattering(const SurfaceInput& input, const SurfaceRequest& request) {
  if (input.scatters) return;
  constexpr std::size_t most_ids = 20;
  std::vector<int> wanted;
  for (const NamedProfile& named : request.profiles)
    if (named.id) wanted.push_back(*named.id);
  std::set<float> seen;
  for (const float id : input.loaded.material)
    if (seen.size() < most_ids && !std::isnan(id)) seen.insert(id);
  throw Error(ErrorCode::role_missing, wanted.empty() ? "--profile" : "--material",
              wanted.empty() ? "a picture of background only"
                             : fmt::format("{}, and no pixel of it that scatters; the ids in the picture are {}{}",
                                           fmt::join(wanted, ", "), fmt::join(seen, ", "),
                                           seen.size() == most_ids ? " and more" : ""),
              "something that scatters, or --allow-empty");
}

void transmit_light(const Device& device, const SurfaceRequest& request, const Frame& frame, SurfaceInput& input) {
  if (!request.lights) return;
  const TranslucencyImages& images = *input.translucency;
  const std::vector<Light> sources = request.lights->lights();
  const TranslucencyFrame lit = {.width = frame.width,
                                 .height = frame.height,
                                 .light = frame.light,
                                 .albedo = frame.albedo,
                                 .position = image_of(images.position),
                                 .normal = image_of(images.normal),
                                 .material = frame.material,
                                 .mask = frame.mask,
                                 .thickness = image_of(images.thickness),
                                 .beauty = frame.beauty,
                                 .mm_per_unit = frame.mm_per_unit,
                                 .lights = sources,
                                 .lit = {.host = input.loaded.light.data()},
                                 .result = frame.result};
  TranslucencyOptions options = request.translucency;
  options.lighting = input.lighting;
  Translucency(device, materials_of(request.profiles), lit.description(), options).run(lit);
}

}  // namespace dermis::program
