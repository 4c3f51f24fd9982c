#include "dermis/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "lighting/check_range.hpp"
#include "lighting/highlight_tables.hpp"
#include "lighting/lit_frame.hpp"
#include "opencl/pixel_stage.hpp"
#include "opencl/program.hpp"

namespace dermis {

namespace {

enum Name { position, normal, albedo, light, seen, specular, beauty };
constexpr int image_count = beauty + 1;
using Images = std::array<CallerImage, image_count>;

void check_options(const ShadingOptions& options) {
  if (options.lobes.size() > 4) {
    throw Error(ErrorCode::usage, "lobes", std::to_string(options.lobes.size()), "at most 4");
  }
  for (const SpecularLobe& lobe : options.lobes) {
    check_range("roughness", lobe.roughness, 0.02, 1, "0.02..1");
    check_range("weight", lobe.weight, 0, 1e6, "0 or more");
  }
  check_range("reflectance", options.reflectance, 0, 1, "0..1");
  check_range("normal_offset_texels", options.normal_offset_texels, 0, 1e6, "0..1e6 texels");
  check_range("softness_texels", options.softness_texels, 0, 16, "0..16 texels");
}

Images check_images(const ShadingFrame& frame) {
  check_size(frame.width, frame.height, "frame size");
  const int w = frame.width;
  const Images images = {described("position", 3, frame.position, w), described("normal", 3, frame.normal, w),
                         described("albedo", 3, frame.albedo, w),     described("light", 3, frame.light, w),
                         described("seen", 3, frame.seen, w),         described("specular", 3, frame.specular, w),
                         described("beauty", 3, frame.beauty, w)};
  for (const CallerImage& image : images) {
    check_image(image, frame.width, frame.height);
    if (!image.is_output && !image.present()) throw Error(ErrorCode::role_missing, image.name, "no image", "an image");
  }
  if (!frame.light && !frame.seen && !frame.specular && !frame.beauty) {
    throw Error(ErrorCode::usage, "outputs", "none", "a light, seen, specular or beauty image");
  }
  return images;
}

/// The place of an eye and 1, or the direction to the viewer and 0.
std::array<double, 4> viewer_of(const Viewer& viewer) {
  for (const double value : viewer.place) check_range("viewer", value, -1e18, 1e18, "three finite numbers");
  const auto& [x, y, z] = viewer.place;
  if (viewer.projection == Camera::Projection::perspective) return {x, y, z, 1};
  const double length = std::hypot(x, y, z);
  check_range("viewer direction length", length, 1e-18, 1e18, "a length above 0");
  return {-x / length, -y / length, -z / length, 0};
}

}  // namespace

struct Shading::State {
  Device device;
  ShadingOptions options;
  cl::Program program;
  params::TableParams beckmann;
  cl::Buffer tables;
  cl::Buffer reflected;
  double seen_gain;  ///< 1 / (1 - rho_mean)

  mutable MemoryPool<LightMemory> memories = {};

  params::ShadingParams params_of(const ShadingFrame& frame) const;
  void launch(CommandChain& commands, const ImageBuffers& images, const Images& its_images, const LightMemory& lights,
              const ShadingFrame& frame) const;
};

Shading::Shading(const Device& device, const ShadingOptions& options) {
  check_options(options);
  const HighlightTables tables = make_highlight_tables(options);
  const std::string constants = scalar_build_options() + build_constant("PIXEL_WIDTH", 0) +
                                build_constant("TABLE_SHIFT", 23 - log2_nodes_per_octave_of_lobes);
  state_ = with_device_errors([&] {
    const cl::Context context(device.context(), true);
    return std::unique_ptr<const State>(
        new State{device, options, build_program(device, {"lighting/shadow_maps.cl", "lighting/shade.cl"}, constants),
                  tables.beckmann, upload_rows(context, tables.nodes), upload_rows(context, tables.reflected),
                  1 / (1 - tables.mean_reflected)});
  });
}

Shading::~Shading() = default;
Shading::Shading(Shading&&) noexcept = default;
Shading& Shading::operator=(Shading&&) noexcept = default;

params::ShadingParams Shading::State::params_of(const ShadingFrame& frame) const {
  const std::array<double, 4> viewer = viewer_of(frame.viewer);
  params::ShadingParams p{};
  std::transform(viewer.begin(), viewer.end(), p.viewer, [](double value) { return static_cast<float>(value); });
  p.width = frame.width;
  p.lights = static_cast<int>(frame.lights.size());
  p.writes_light = frame.light ? 1 : 0;
  p.writes_seen = frame.seen ? 1 : 0;
  p.writes_specular = frame.specular ? 1 : 0;
  p.writes_beauty = frame.beauty ? 1 : 0;
  p.beckmann = beckmann;
  p.reflectance = static_cast<float>(options.reflectance);
  p.seen_gain = static_cast<float>(seen_gain);
  p.offset_texels = static_cast<float>((options.normal_offset_texels + options.softness_texels) * std::numbers::sqrt2);
  p.softness_texels = static_cast<float>(options.softness_texels);
  return p;
}

void Shading::State::launch(CommandChain& commands, const ImageBuffers& images, const Images& its_images,
                            const LightMemory& lights, const ShadingFrame& frame) const {
  check_outputs(images, its_images, {{light, -1}, {seen, albedo}, {specular, -1}, {beauty, -1}});
  const params::ShadingImages layouts = {images.layout(position), images.layout(normal), images.layout(albedo),
                                         images.layout(light),    images.layout(seen),   images.layout(specular),
                                         images.layout(beauty)};
  const auto output = [&](Name name) { return images.buffer(images.has(name) ? name : position); };
  cl::Kernel kernel(program, "shade");
  set_arguments(kernel, layouts, params_of(frame), images.buffer(position), images.buffer(normal),
                images.buffer(albedo), output(light), output(seen), output(specular), output(beauty), lights.lights,
                lights.maps, tables, reflected);
  commands.launch(kernel, lines(device, frame.width, frame.height));
}

void Shading::run(const ShadingFrame& frame) const {
  const Images images = check_images(frame);
  make_light_params(frame.lights);  // throws if one is wrong, before anything is done
  viewer_of(frame.viewer);          // the same
  with_device_errors([&] {
    run_lit(state_->device, state_->memories, state_->program, frame.width, frame.height, images, frame.lights,
            [&](CommandChain& commands, const ImageBuffers& bound, const LightMemory& lights) {
              state_->launch(commands, bound, images, lights, frame);
            });
  });
}

Event Shading::enqueue(const ShadingFrame& frame, cl_command_queue queue, std::span<const cl_event> wait_for) const {
  const Images images = check_images(frame);
  make_light_params(frame.lights);
  viewer_of(frame.viewer);
  return with_device_errors([&] {
    return enqueue_lit(
        state_->device, state_->memories, state_->program, frame.width, frame.height, images, frame.lights,
        [&](CommandChain& commands, const ImageBuffers& bound, const LightMemory& lights) {
          state_->launch(commands, bound, images, lights, frame);
        },
        queue, wait_for);
  });
}

}  // namespace dermis
