#include "dermis/translucency.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "lighting/check_range.hpp"
#include "lighting/lit_frame.hpp"
#include "lighting/slab_tables.hpp"
#include "opencl/pixel_stage.hpp"
#include "opencl/program.hpp"
#include "screen/check_materials.hpp"

namespace dermis {

namespace {

enum Name { light, albedo, position, normal, material, mask, thickness, beauty, lit, result };
constexpr int image_count = result + 1;
using Images = std::array<CallerImage, image_count>;

void check_options(const TranslucencyOptions& options) {
  check_range("shrink_units", options.shrink_units, 0, 1e18, "0..1e18 scene units");
  check_range("thickness_scale", options.thickness_scale, 1e-18, 1e18, "1e-18..1e18");
  check_range("softness_texels", options.softness_texels, 0, 16, "0..16 texels");
}

void check_lighting(const TranslucencyDescription& frames, const TranslucencyOptions& options) {
  if (options.lighting == Lighting::lit && !frames.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image", "an albedo image, as the light has the albedo in it");
  }
}

Images check_images(const TranslucencyFrame& frame, const TranslucencyDescription& description) {
  check_size(frame.width, frame.height, "frame size");
  check_range("mm_per_unit", frame.mm_per_unit, 1e-18, 1e18, "1e-18..1e18");
  const int w = frame.width;
  const Images images = {described("light", 3, frame.light, w),
                         described("albedo", 3, frame.albedo, w),
                         described("position", 3, frame.position, w),
                         described("normal", 3, frame.normal, w),
                         described("material", 1, frame.material, w, true),
                         described("mask", 1, frame.mask, w),
                         described("thickness", 1, frame.thickness, w),
                         described("beauty", 3, frame.beauty, w),
                         described("lit", 3, frame.lit, w),
                         described("result", 3, frame.result, w)};
  for (const CallerImage& image : images) check_image(image, frame.width, frame.height);
  if (!(frame.description() == description)) {
    throw Error(ErrorCode::usage, "frame", "albedo, material, mask or thickness other than described",
                "the images that the Translucency was made for");
  }
  for (const int needed : {light, position, normal}) {
    if (!images[needed].present()) throw Error(ErrorCode::role_missing, images[needed].name, "no image", "an image");
  }
  if (!frame.lit && !frame.result) throw Error(ErrorCode::usage, "outputs", "none", "a lit or a result image");
  if (frame.result && (!frame.beauty || !frame.albedo)) {
    throw Error(ErrorCode::role_missing, frame.beauty ? "albedo" : "beauty", "no image",
                "beauty and albedo, to put transmitted light into the result");
  }
  const bool has_map = std::any_of(frame.lights.begin(), frame.lights.end(),
                                   [](const Light& its) { return static_cast<bool>(its.map.depth); });
  if (!frame.lights.empty() && !has_map && !frame.thickness) {
    throw Error(ErrorCode::role_missing, "thickness", "no image, and no light with a shadow map", "one of them");
  }
  return images;
}

}  // namespace

struct Translucency::State {
  Device device;
  TranslucencyDescription description;
  TranslucencyOptions options;
  cl::Program program;
  cl::Buffer slabs;
  cl::Buffer tables;

  mutable MemoryPool<LightMemory> memories = {};

  /// All but which inputs are copied.
  params::TranslucencyParams params_of(const TranslucencyFrame& frame) const;
  void launch(CommandChain& commands, const ImageBuffers& images, const Images& its_images, const LightMemory& lights,
              const TranslucencyFrame& frame) const;
};

Translucency::Translucency(const Device& device, const std::vector<Material>& materials,
                           const TranslucencyDescription& frames, const TranslucencyOptions& options) {
  check_options(options);
  check_materials(materials, frames.material, frames.albedo);
  check_lighting(frames, options);
  const std::string constants =
      scalar_build_options() + build_constant("MATERIALS", static_cast<int>(materials.size())) +
      build_constant("HAS_ALBEDO", frames.albedo ? 1 : 0) + build_constant("HAS_MATERIAL", frames.material ? 1 : 0) +
      build_constant("HAS_MASK", frames.mask ? 1 : 0) + build_constant("HAS_THICKNESS", frames.thickness ? 1 : 0) +
      build_constant("PIXEL_WIDTH", frames.mask || any_follows_albedo(materials) ? 1 : 0) +
      build_constant("LIT", options.lighting == Lighting::lit ? 1 : 0) +
      build_constant("TABLE_SHIFT", 23 - log2_nodes_per_octave_of_slabs);
  const SlabTables tables = make_slab_tables(materials);
  state_ = with_device_errors([&] {
    const cl::Context context(device.context(), true);
    return std::unique_ptr<const State>(new State{
        device, frames, options, build_program(device, {"lighting/shadow_maps.cl", "lighting/transmit.cl"}, constants),
        upload_rows(context, tables.materials), upload_rows(context, tables.nodes)});
  });
}

Translucency::~Translucency() = default;
Translucency::Translucency(Translucency&&) noexcept = default;
Translucency& Translucency::operator=(Translucency&&) noexcept = default;

params::TranslucencyParams Translucency::State::params_of(const TranslucencyFrame& frame) const {
  params::TranslucencyParams p{};
  p.width = frame.width;
  p.lights = static_cast<int>(frame.lights.size());
  p.writes_lit = frame.lit ? 1 : 0;
  p.writes_result = frame.result ? 1 : 0;
  p.mm_per_unit = static_cast<float>(frame.mm_per_unit);
  p.thickness_scale = static_cast<float>(options.thickness_scale);
  p.shrink_units = static_cast<float>(options.shrink_units);
  p.softness_texels = static_cast<float>(options.softness_texels);
  return p;
}

void Translucency::State::launch(CommandChain& commands, const ImageBuffers& images, const Images& its_images,
                                 const LightMemory& lights, const TranslucencyFrame& frame) const {
  check_outputs(images, its_images, {{lit, light}, {result, beauty}});
  const params::TranslucencyImages layouts = {
      images.layout(light),    images.layout(albedo), images.layout(position),  images.layout(normal),
      images.layout(material), images.layout(mask),   images.layout(thickness), images.layout(beauty),
      images.layout(lit),      images.layout(result)};
  params::TranslucencyParams params = params_of(frame);
  params.copies_light = images.same_place(lit, light) ? 0 : 1;
  params.copies_beauty = images.same_place(result, beauty) ? 0 : 1;
  const auto buffer = [&](Name name) { return images.buffer(images.has(name) ? name : light); };
  cl::Kernel kernel(program, "transmit");
  set_arguments(kernel, layouts, params, buffer(light), buffer(albedo), buffer(position), buffer(normal),
                buffer(material), buffer(mask), buffer(thickness), buffer(beauty), buffer(lit), buffer(result),
                lights.lights, lights.maps, slabs, tables);
  commands.launch(kernel, lines(device, frame.width, frame.height));
}

void Translucency::run(const TranslucencyFrame& frame) const {
  const Images images = check_images(frame, state_->description);
  make_light_params(frame.lights);  // throws if one is wrong, before anything is done
  with_device_errors([&] {
    run_lit(state_->device, state_->memories, state_->program, frame.width, frame.height, images, frame.lights,
            [&](CommandChain& commands, const ImageBuffers& bound, const LightMemory& lights) {
              state_->launch(commands, bound, images, lights, frame);
            });
  });
}

Event Translucency::enqueue(const TranslucencyFrame& frame, cl_command_queue queue,
                            std::span<const cl_event> wait_for) const {
  const Images images = check_images(frame, state_->description);
  make_light_params(frame.lights);
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
