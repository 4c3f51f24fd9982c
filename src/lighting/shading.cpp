#include "dermis/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "lighting/highlight_tables.hpp"
#include "lighting/light_tables.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/pixel_stage.hpp"
#include "opencl/program.hpp"

namespace dermis {

namespace {

enum Name { position, normal, albedo, light, seen, specular, beauty };
constexpr int image_count = beauty + 1;
using Images = std::array<CallerImage, image_count>;

void check_range(const char* argument, double value, double low, double high, const char* wanted) {
  if (!(value >= low && value <= high)) throw Error(ErrorCode::usage, argument, std::to_string(value), wanted);
}

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

/// The place of an eye with w = 1, or the direction to the viewer with w = 0.
cl_float4 viewer_of(const Viewer& viewer) {
  for (const double value : viewer.place) check_range("viewer", value, -1e18, 1e18, "three finite numbers");
  const auto& [x, y, z] = viewer.place;
  if (viewer.projection == Camera::Projection::perspective) {
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 1}};
  }
  const double length = std::hypot(x, y, z);
  check_range("viewer direction length", length, 1e-18, 1e18, "a length above 0");
  return {{static_cast<float>(-x / length), static_cast<float>(-y / length), static_cast<float>(-z / length), 0}};
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
};

Shading::Shading(const Device& device, const ShadingOptions& options) {
  check_options(options);
  const HighlightTables tables = make_highlight_tables(options);
  const std::string constants = scalar_build_options() + build_constant("PIXEL_WIDTH", 0) +
                                build_constant("TABLE_SHIFT", 23 - log2_nodes_per_octave_of_lobes);
  state_ = with_device_errors([&] {
    const cl::Context context(device.context(), true);
    return std::make_unique<State>(
        State{device, options, build_program(device, {"lighting/shadow_maps.cl", "lighting/shade.cl"}, constants),
              tables.beckmann, upload_rows(context, tables.nodes), upload_rows(context, tables.reflected),
              1 / (1 - tables.mean_reflected)});
  });
}

Shading::~Shading() = default;
Shading::Shading(Shading&&) noexcept = default;
Shading& Shading::operator=(Shading&&) noexcept = default;

void Shading::run(const ShadingFrame& frame) const {
  const Images images = check_images(frame);
  make_light_params(frame.lights);  // what is wrong with them, before anything is done
  const cl_float4 viewer = viewer_of(frame.viewer);
  with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue queue = cache_of(state_->device).queue(state_->device);
    const ImageBuffers memory(context, frame.width, frame.height, images);
    check_outputs(memory, images, {{light, -1}, {seen, albedo}, {specular, -1}, {beauty, -1}});
    const BoundLights lights(context, queue, state_->program, frame.lights);
    const double offset_texels =
        (state_->options.normal_offset_texels + state_->options.softness_texels) * std::numbers::sqrt2;
    const auto output = [&](Name name) { return memory.buffer(memory.has(name) ? name : position); };
    run_per_pixel(queue, state_->program, "shade", frame.width, frame.height, frame.width, memory.buffer(position),
                  memory.layout(position), memory.buffer(normal), memory.layout(normal), memory.buffer(albedo),
                  memory.layout(albedo), output(light), memory.layout(light), output(seen), memory.layout(seen),
                  output(specular), memory.layout(specular), output(beauty), memory.layout(beauty), frame.light ? 1 : 0,
                  frame.seen ? 1 : 0, frame.specular ? 1 : 0, frame.beauty ? 1 : 0, lights.lights(), lights.count(),
                  lights.maps(), state_->tables, state_->beckmann, state_->reflected,
                  static_cast<float>(state_->options.reflectance), static_cast<float>(state_->seen_gain), viewer,
                  static_cast<float>(offset_texels), static_cast<float>(state_->options.softness_texels));
    queue.finish();
    memory.read_back(queue);
  });
}

}  // namespace dermis
