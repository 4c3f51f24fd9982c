#include "screen/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "opencl/program.hpp"
#include "screen/disc_tables.hpp"

namespace dermis {

namespace {

constexpr int rows_per_step_px = 16;  ///< of a method that takes long

params::FrameParams frame_params(const Frame& frame, const Options& options, const RunSizes& sizes) {
  const Camera& camera = frame.camera;
  const bool perspective = camera.projection == Camera::Projection::perspective;
  params::FrameParams p{};
  p.width = frame.width;
  p.height = frame.height;
  p.stride = sizes.stride();
  p.blocks_x = sizes.blocks_x();
  p.blocks_y = sizes.blocks_y();
  p.tile_width = sizes.tile_width;
  p.tile_height = sizes.tile_height;
  p.least_tile_height = sizes.least_tile_height;
  p.tiles_x = sizes.tiles_x();
  p.tiles_y = sizes.tiles_y(sizes.tile_height);
  p.mm_per_unit = static_cast<float>(frame.mm_per_unit);
  if (perspective) {
    p.slope_x = static_cast<float>(1 / camera.scale_x);
    p.slope_y = static_cast<float>(1 / camera.scale_y);
  } else {
    p.mm_per_px_x = static_cast<float>(frame.mm_per_unit / camera.scale_x);
    p.mm_per_px_y = static_cast<float>(frame.mm_per_unit / camera.scale_y);
  }
  p.center_x = static_cast<float>(camera.center_x);
  p.center_y = static_cast<float>(camera.center_y);
  p.albedo_mix = static_cast<float>(options.albedo_mix);
  p.widest_turn = static_cast<float>(std::max({1.0, camera.scale_y / camera.scale_x, camera.scale_x / camera.scale_y}));
  return p;
}

/// The cosine and the sine of multiples of 2 pi / 256.
std::array<std::array<float, 2>, ROTATIONS> disc_turns() {
  std::array<std::array<float, 2>, ROTATIONS> turns{};
  for (int i = 0; i < ROTATIONS; ++i) {
    const double angle = 2 * std::numbers::pi * i / ROTATIONS;
    turns[i] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return turns;
}

/// The axes turned by multiples of 2 pi / 256, in whole 1/4096 px so that every device rounds alike. Lengths in mm are
/// kept where pixels are not square.
std::array<params::RotationParams, ROTATIONS> rotations(const Camera& camera) {
  constexpr double one = 4096;
  std::array<params::RotationParams, ROTATIONS> table{};
  for (int i = 0; i < ROTATIONS; ++i) {
    const double angle = 2 * std::numbers::pi * i / ROTATIONS;
    table[i] = {static_cast<int>(std::lround(one * std::cos(angle))),
                static_cast<int>(std::lround(one * std::sin(angle) * camera.scale_y / camera.scale_x)),
                static_cast<int>(std::lround(-one * std::sin(angle) * camera.scale_x / camera.scale_y)), 0};
  }
  return table;
}

}  // namespace

RunSizes run_sizes(const Plan::State& plan, int width, int height) {
  constexpr int tile_width_px = 240;
  constexpr int most_tile_px = 512;
  constexpr int most_turned_tile_px = 256;
  constexpr int least_tile_px = 32;
  const Options& options = plan.options;
  RunSizes sizes{};
  sizes.width = width;
  sizes.height = height;
  sizes.turns_taps = options.jitter > 0;
  sizes.tile_width = options.tile_width > 0 ? options.tile_width : tile_width_px;
  sizes.tile_height = sizes.least_tile_height = options.tile_height;
  sizes.workers = plan.tiled ? std::max(1, plan.device.info().compute_units) : 0;
  if (sizes.tile_height == 0) {
    // The device fits the height to what scatters; with turned taps, memory grows with it.
    sizes.tile_height = sizes.turns_taps ? most_turned_tile_px : most_tile_px;
    sizes.least_tile_height = least_tile_px;
  }
  sizes.terms = plan.terms_per_material;
  sizes.side_px = plan.is_sheared ? MOST_SIDE : 0;
  sizes.farthest_px = plan.farthest_px;
  sizes.has_pixel_width = plan.has_pixel_width;
  sizes.method = options.method;
  sizes.texel_levels = options.disc.prefiltered ? MOST_TEXEL_LEVELS : 1;
  return sizes;
}

Passes::Passes(const Plan::State& plan, const Frame& frame, const BoundImages& images, RunMemory& memory,
               cl::CommandQueue queue, std::span<const cl_event> wait_for, Reuse::State* reuse)
    : plan_(plan),
      images_(images),
      memory_(memory),
      queue_(std::move(queue)),
      params_(frame_params(frame, plan.options, memory.sizes)),
      window_{0,
              (frame.width + BLOCK - 1) / BLOCK * BLOCK,
              0,
              frame.height,
              std::numeric_limits<int>::max(),
              memory.sizes.stride()},
      reuse_(plan.tiled ? reuse : nullptr),
      follows_(reuse_ != nullptr && reuse_->continues(plan, memory.sizes, frame)) {
  for (const cl_event event : wait_for) last_.emplace_back(event, true);
  const cl::Context context(plan.device.context(), true);
  const bool light_is_scattered = plan.options.lighting == Lighting::raw && plan.options.albedo_mix == 0;
  copies_ = (images.has(ImageName::scattered) &&
             !(light_is_scattered && images.in_place(ImageName::scattered, ImageName::light))) ||
            (images.has(ImageName::result) && !images.in_place(ImageName::result, ImageName::beauty)) ||
            plan.options.bad_pixels == BadPixels::zero;
  defers_ = plan.options.bad_pixels == BadPixels::error || reuse_ != nullptr;
  for (const ImageName input :
       {ImageName::light, ImageName::albedo, ImageName::depth, ImageName::mask, ImageName::matte}) {
    defers_ = defers_ || images.output_over(input);
  }
  if (defers_ && reuse_ == nullptr) memory.need_deferred(context);
  deferred_ = reuse_ != nullptr ? reuse_->deferred : memory.deferred;
  if (plan.options.method == Method::disc) {
    auto table = disc_turns();
    rotations_ = cl::Buffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof(table), table.data());
  } else if (plan.options.jitter > 0) {
    auto table = rotations(frame.camera);
    rotations_ = cl::Buffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof(table), table.data());
  } else {
    rotations_ = plan.offsets;
  }
}

cl::Event Passes::launch(cl::Kernel& kernel, int columns, int rows, int local) {
  cl::Event event;
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(columns, rows),
                              local > 0 ? cl::NDRange(local, local) : cl::NullRange, last_.empty() ? nullptr : &last_,
                              &event);
  last_ = {event};
  return event;
}

int Passes::runs() const { return plan_.item_is_pixel ? params_.width : 1; }

void Passes::classify() {
  cl::Event cleared;
  queue_.enqueueFillBuffer(memory_.counters, cl_int{0}, 0, RUN_COUNTERS * sizeof(cl_int),
                           last_.empty() ? nullptr : &last_, &cleared);
  last_ = {cleared};
  const int blocks_per_item = plan_.item_is_pixel ? 1 : params_.blocks_x;
  const int columns = plan_.item_is_pixel ? params_.blocks_x : 1;
  cl::Kernel classify(plan_.classify_program, "classify_blocks");
  set_arguments(classify, params_, blocks_per_item, plan_.materials,                       //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),      //
                images_.buffer(ImageName::depth), images_.layout(ImageName::depth),        //
                images_.buffer(ImageName::material), images_.layout(ImageName::material),  //
                images_.buffer(ImageName::mask), images_.layout(ImageName::mask),          //
                images_.buffer(ImageName::matte), images_.layout(ImageName::matte),        //
                memory_.material_ids, memory_.blocks);
  events_.classify.push_back(launch(classify, columns, params_.blocks_y, 1));
  cl::Kernel choose(plan_.classify_program, "choose_passes");
  set_arguments(choose, params_, blocks_per_item, plan_.materials, plan_.levels, memory_.blocks, memory_.passes,
                memory_.counters);
  events_.classify.push_back(launch(choose, columns, params_.blocks_y, 1));
  if (reuse_ != nullptr) compare_with_frame_before();
  if (!plan_.tiled) prepare();
}

void Passes::compare_with_frame_before() {
  const cl::Program program =
      build_program(plan_.device, {"classify/fingerprint.cl"}, plan_.build_options + " -DV=" + std::to_string(BLOCK));
  cl::Kernel kernel(program, "fingerprint");
  set_arguments(kernel, params_, params_.blocks_x,                                         //
                images_.buffer(ImageName::light), images_.layout(ImageName::light),        //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),      //
                images_.buffer(ImageName::depth), images_.layout(ImageName::depth),        //
                images_.buffer(ImageName::material), images_.layout(ImageName::material),  //
                images_.buffer(ImageName::mask), images_.layout(ImageName::mask),          //
                images_.buffer(ImageName::matte), images_.layout(ImageName::matte),        //
                reuse_->fingerprints, follows_ ? 0 : 1, reuse_->changed);
  events_.classify.push_back(launch(kernel, 1, params_.blocks_y, 1));
}

void Passes::prepare() {
  const auto plane = static_cast<cl_long>(memory_.sizes.frame_plane());
  const int columns = plan_.item_is_pixel ? 1 : memory_.sizes.stride();
  cl::Kernel prepare(plan_.program, "prepare");
  set_arguments(prepare, params_, window_, plan_.materials, memory_.material_ids,      //
                images_.buffer(ImageName::light), images_.layout(ImageName::light),    //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),  //
                images_.buffer(ImageName::depth), images_.layout(ImageName::depth),    //
                images_.buffer(ImageName::mask), images_.layout(ImageName::mask),      //
                images_.buffer(ImageName::matte), images_.layout(ImageName::matte),    //
                memory_.windows, plane, columns, memory_.counters);
  const int items = plan_.item_is_pixel ? memory_.sizes.stride() : 1;
  events_.classify.push_back(launch(prepare, items, params_.height, plan_.item_is_pixel ? 0 : 1));
  if (plan_.options.method == Method::disc) {
    prepare_discs(plane);
  } else if (plan_.options.method == Method::exact) {
    cl::Kernel slopes(plan_.program, "slopes");
    set_arguments(slopes, params_, window_, memory_.windows, plane, images_.buffer(ImageName::matte),
                  images_.layout(ImageName::matte), memory_.between, columns);
    events_.classify.push_back(launch(slopes, runs(), params_.height, plan_.item_is_pixel ? 0 : 1));
  } else {
    cl::Kernel segments(plan_.program, "segments");
    set_arguments(segments, params_, window_, memory_.windows, plane, images_.buffer(ImageName::matte),
                  images_.layout(ImageName::matte), memory_.segments);
    events_.classify.push_back(launch(segments, params_.width, params_.height, 0));
  }
}

void Passes::prepare_discs(cl_long plane) {
  const params::TexelLevels levels = memory_.sizes.levels();
  const int local = plan_.item_is_pixel ? 0 : 1;
  cl::Kernel texels(plan_.program, "texels");
  set_arguments(texels, params_, window_, memory_.windows, plane, images_.buffer(ImageName::matte),
                images_.layout(ImageName::matte), memory_.between, plan_.item_is_pixel ? 1 : params_.width);
  events_.classify.push_back(launch(texels, runs(), params_.height, local));
  for (int level = 1; level < levels.count; ++level) {
    const int columns = params_.width >> level;
    cl::Kernel halve(plan_.program, "halve_texels");
    set_arguments(halve, params_, levels, level, memory_.between, plan_.item_is_pixel ? 1 : columns);
    events_.classify.push_back(launch(halve, plan_.item_is_pixel ? columns : 1, params_.height >> level, local));
  }
  cl::Kernel light(plan_.program, "light_blocks");
  set_arguments(light, params_, memory_.between, memory_.segments);
  events_.classify.push_back(launch(light, params_.blocks_x, params_.blocks_y, local));
  cl::Kernel dark(plan_.program, "dark_blocks");
  set_arguments(dark, params_, plan_.discs, memory_.blocks, memory_.segments);
  events_.classify.push_back(launch(dark, params_.blocks_x, params_.blocks_y, local));
}

int Passes::scatter_steps() const {
  return plan_.options.method == Method::separable ? 1 : (params_.height + rows_per_step_px - 1) / rows_per_step_px;
}

void Passes::scatter(int step) {
  const int first_row = step * rows_per_step_px;
  const int rows = std::min(rows_per_step_px, params_.height - first_row);
  if (plan_.options.method == Method::exact) {
    scatter_exactly(first_row, rows);
  } else if (plan_.options.method == Method::disc) {
    scatter_discs(first_row, rows);
  } else if (plan_.tiled) {
    scatter_tiles();
  } else {
    scatter_pixels();
  }
}

void Passes::scatter_tiles() {
  cl::Kernel kernel(plan_.program, "scatter");
  const auto flag = [](bool value) { return value ? 1 : 0; };
  set_arguments(
      kernel, params_, plan_.materials, plan_.terms, plan_.levels, plan_.offsets, plan_.weights, plan_.flat_weights,
      plan_.smooth_weights, rotations_, plan_.options.seed, memory_.material_ids, memory_.blocks, memory_.passes,  //
      images_.buffer(ImageName::light), images_.layout(ImageName::light),                                          //
      images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),                                        //
      images_.buffer(ImageName::depth), images_.layout(ImageName::depth),                                          //
      images_.buffer(ImageName::mask), images_.layout(ImageName::mask),                                            //
      images_.buffer(ImageName::matte), images_.layout(ImageName::matte),                                          //
      images_.buffer(ImageName::beauty), images_.layout(ImageName::beauty),                                        //
      images_.buffer(ImageName::scattered), images_.layout(ImageName::scattered),                                  //
      flag(images_.has(ImageName::scattered)),                                                                     //
      images_.buffer(ImageName::result), images_.layout(ImageName::result),                                        //
      flag(images_.has(ImageName::result)), flag(plan_.options.bad_pixels == BadPixels::zero),                     //
      flag(copies_), flag(plan_.options.skip_uniform_light), flag(defers_), deferred_, flag(follows_),             //
      reuse_ != nullptr ? reuse_->changed : memory_.kinds,                                                         //
      memory_.windows, static_cast<cl_long>(memory_.sizes.horizontal_plane()),                                     //
      static_cast<cl_long>(memory_.sizes.vertical_plane()), memory_.sizes.workers, memory_.kinds, memory_.counters);
  // A device may give a thread several work-items in one go.
  constexpr int items_per_worker = 8;
  events_.scatter.push_back(launch(kernel, items_per_worker * memory_.sizes.workers, 1, 1));
}

void Passes::scatter_pixels() {
  const auto plane = static_cast<cl_long>(memory_.sizes.frame_plane());
  for (const char* name : {"scatter_x", "scatter_y"}) {
    cl::Kernel kernel(plan_.program, name);
    set_arguments(kernel, params_, window_, plan_.materials, plan_.terms, plan_.levels, plan_.offsets, plan_.weights,
                  plan_.flat_weights, plan_.smooth_weights, rotations_, plan_.options.seed, memory_.passes,
                  memory_.windows, plane, memory_.between, memory_.segments);
    if (events_.scatter.size() == 1) kernel.setArg(16, memory_.deferred);
    events_.scatter.push_back(launch(kernel, params_.width, params_.height, 0));
  }
}

void Passes::scatter_exactly(int first_row, int rows) {
  cl::Kernel kernel(plan_.program, "exact");
  set_arguments(kernel, params_, window_, first_row, plan_.materials, plan_.nodes, memory_.windows,
                static_cast<cl_long>(memory_.sizes.frame_plane()), memory_.between,
                plan_.item_is_pixel ? 1 : params_.width, memory_.deferred);
  events_.scatter.push_back(launch(kernel, runs(), rows, plan_.item_is_pixel ? 0 : 1));
}

void Passes::scatter_discs(int first_row, int rows) {
  const Options& options = plan_.options;
  const params::DiscCounts counts = disc_counts(options.disc, options.seed);
  cl::Kernel kernel(plan_.program, "disc");
  set_arguments(kernel, params_, window_, first_row, plan_.materials, plan_.nodes, plan_.discs, plan_.samples, counts,
                rotations_, memory_.windows, static_cast<cl_long>(memory_.sizes.frame_plane()), memory_.sizes.levels(),
                memory_.between, memory_.segments,                                     //
                images_.buffer(ImageName::normal), images_.layout(ImageName::normal),  //
                plan_.item_is_pixel ? 1 : params_.width, memory_.deferred, memory_.counters);
  events_.scatter.push_back(launch(kernel, runs(), rows, plan_.item_is_pixel ? 0 : 1));
}

void Passes::finish() {
  if (plan_.tiled && !defers_) return;
  cl::Kernel kernel(plan_.program, "finish");
  const auto flag = [](bool value) { return value ? 1 : 0; };
  set_arguments(kernel, params_, memory_.material_ids,                                                    //
                images_.buffer(ImageName::light), images_.layout(ImageName::light),                       //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),                     //
                images_.buffer(ImageName::matte), images_.layout(ImageName::matte),                       //
                images_.buffer(ImageName::beauty), images_.layout(ImageName::beauty),                     //
                images_.buffer(ImageName::scattered), images_.layout(ImageName::scattered),               //
                flag(images_.has(ImageName::scattered)),                                                  //
                images_.buffer(ImageName::result), images_.layout(ImageName::result),                     //
                flag(images_.has(ImageName::result)), flag(plan_.options.bad_pixels == BadPixels::zero),  //
                flag(copies_ || !plan_.tiled), deferred_, memory_.kinds, memory_.counters, memory_.passes,
                plan_.item_is_pixel ? 1 : params_.width);
  events_.finish.push_back(launch(kernel, runs(), params_.height, plan_.item_is_pixel ? 0 : 1));
}

std::array<int, RUN_COUNTERS> Passes::counters() const {
  std::array<cl_int, RUN_COUNTERS> counters{};
  queue_.enqueueReadBuffer(memory_.counters, CL_TRUE, 0, sizeof(counters), counters.data(), &last_);
  return counters;
}

int Passes::bad_pixels() const { return counters()[COUNTER_BAD]; }

void Passes::add_to(Stats& stats) const {
  const RunSizes& sizes = memory_.sizes;
  const auto counted = counters();
  stats.pixels = static_cast<std::int64_t>(sizes.width) * sizes.height;
  stats.pixels_scattered = counted[COUNTER_SCATTERED];
  stats.pixels_narrow = counted[COUNTER_NARROW];
  stats.pixels_without_material = stats.pixels - stats.pixels_scattered - stats.pixels_narrow;
  stats.pixels_flat = counted[COUNTER_FLAT];
  stats.pixels_smooth = counted[COUNTER_SMOOTH];
  stats.channels_narrow = counted[COUNTER_CHANNELS];
  stats.pixels_bad = counted[COUNTER_BAD];
  stats.pixels_unlit = counted[COUNTER_UNLIT];
  if (!plan_.tiled) return;
  TileMap& tiles = stats.tiles;
  const int tile_height = counted[COUNTER_TILE_HEIGHT];
  tiles = {sizes.tile_width, tile_height, sizes.tiles_x(), sizes.tiles_y(tile_height), {}};
  tiles.kinds.resize(static_cast<std::size_t>(tiles.columns) * tiles.rows);
  queue_.enqueueReadBuffer(memory_.kinds, CL_TRUE, 0, tiles.kinds.size(), tiles.kinds.data());
}

}  // namespace dermis
