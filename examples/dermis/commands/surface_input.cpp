#include "commands/surface_input.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <future>

#include "arguments/profile_argument.hpp"
#include "files/surface_pixels.hpp"
#include "report/role_text.hpp"

namespace dermis::program {
namespace {

using exr::Role;

/// The size is missing if the pixels are nowhere, or of a size that taps cannot be made for.
std::optional<double> pixel_mm_at(const std::optional<double>& depth_units, const Camera& camera, double mm_per_unit) {
  if (!depth_units) return std::nullopt;
  const double pixel_mm = finest_pixel_mm(camera, *depth_units, mm_per_unit);
  return pixel_mm >= 1e-12 && pixel_mm <= 1e12 ? std::optional(pixel_mm) : std::nullopt;
}

/// Throws Error(role_missing) if the picture lacks a role that is needed.
TranslucencyImages load_translucency_images(const exr::Picture& picture, const exr::Roles& roles) {
  for (const Role role : {Role::position, Role::normal, Role::albedo}) exr::require(picture, roles, role);
  return {exr::load(picture, roles, Role::position), exr::load(picture, roles, Role::normal),
          exr::load(picture, roles, Role::thickness)};
}

}  // namespace

Frame SurfaceInput::frame(double mm_per_unit) const {
  Frame frame = loaded.frame();
  frame.camera = camera.camera;
  frame.mm_per_unit = mm_per_unit;
  return frame;
}

SurfaceInput read_surface(const std::string& path, const SurfaceRequest& request, const Options& options,
                          bool needs_beauty) {
  constexpr std::size_t added_channels = 3;  // of the scattered light
  SurfaceInput input{exr::Picture::read(path, added_channels), {}, {}, {}, {}};
  const exr::Picture& picture = input.picture;
  input.roles = exr::find_roles(picture, request.picture.roles, request.picture.layer);
  require_roles(picture, input.roles, request.profiles, options, !request.cryptomatte.empty());
  if (needs_beauty) exr::require(picture, input.roles, Role::beauty);
  // The camera takes as long to find as the images take to load, and needs none of them.
  auto images = std::async(std::launch::async,
                           [&] { return load_images(picture, input.roles, request.profiles, request.cryptomatte); });
  input.camera = exr::find_camera(picture, input.roles, request.picture.camera);
  fmt::print(stderr, "{}", warnings_of(input.camera, without_folders(path)));
  input.loaded = images.get();
  input.loaded.depth = load_depth_image(picture, input.roles, input.camera);
  if (request.lights) input.translucency = load_translucency_images(picture, input.roles);
  return input;
}

std::vector<MaterialPixels> count_pixels(const SurfaceInput& input, const SurfaceRequest& request) {
  const MaterialCounts counts = count_materials(input.loaded.material, input.loaded.depth);
  std::vector<MaterialPixels> all;
  for (const NamedProfile& named : request.profiles) {
    SurfacePixels pixels;
    if (!named.id) {
      pixels = count_surface(input.loaded.depth, input.loaded.mask);
    } else if (const auto found = counts.by_id.find(*named.id); found != counts.by_id.end()) {
      pixels = found->second;
    } else {
      fmt::print(stderr, "dermis: warning: --material {}: no pixel has this id\n", *named.id);
    }
    const Camera& camera = input.camera.camera;
    all.push_back({pixels.pixels, pixel_mm_at(pixels.median_depth_units, camera, request.mm_per_unit),
                   pixel_mm_at(pixels.nearest_depth_units, camera, request.mm_per_unit)});
  }
  return all;
}

void transmit_light(const Device& device, const SurfaceRequest& request, Lighting lighting, const Frame& frame,
                    SurfaceInput& input) {
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
  options.lighting = lighting;
  Translucency(device, materials_of(request.profiles), lit.description(), options).run(lit);
}

}  // namespace dermis::program
