#include "screen/frame_run.hpp"

#include <algorithm>
#include <utility>

#include "opencl/program.hpp"
#include "screen/methods/window_layout.hpp"
#include "views/hidden_light.hpp"

namespace dermis {

namespace {

params::FrameParams frame_params(const Frame& frame, const Band& band, const Options& options, const FrameSize& size) {
  const Camera& camera = frame.camera;
  params::FrameParams p{};
  p.width = size.width;
  p.height = size.height;
  p.stride = size.stride();
  p.blocks_x = size.blocks_x();
  p.blocks_y = size.blocks_y();
  p.first_row = band.rows.first;
  p.own_begin = band.own.first - band.rows.first;
  p.own_end = band.own.end() - band.rows.first;
  p.mm_per_unit = static_cast<float>(frame.mm_per_unit);
  if (camera.projection == Camera::Projection::perspective) {
    p.slope_x = static_cast<float>(1 / camera.scale_x);
    p.slope_y = static_cast<float>(1 / camera.scale_y);
  } else {
    p.mm_per_px_x = static_cast<float>(frame.mm_per_unit / camera.scale_x);
    p.mm_per_px_y = static_cast<float>(frame.mm_per_unit / camera.scale_y);
  }
  p.center_x = static_cast<float>(camera.center_x);
  p.center_y = static_cast<float>(camera.center_y);
  p.aspect2 = static_cast<float>(camera.scale_x / camera.scale_y * (camera.scale_x / camera.scale_y));
  p.albedo_mix = static_cast<float>(options.albedo_mix);
  p.widest_turn = static_cast<float>(std::max({1.0, camera.scale_y / camera.scale_x, camera.scale_x / camera.scale_y}));
  return p;
}

params::RunFlags run_flags(const Plan::State& plan, const BoundImages& images, bool has_reuse, bool follows) {
  const Options& options = plan.settings.options;
  const bool writes_scattered = images.has(ImageName::scattered);
  const bool writes_result = images.has(ImageName::result);
  const bool light_is_scattered = options.lighting == Lighting::raw && options.albedo_mix == 0;
  const bool copies =
      (writes_scattered && !(light_is_scattered && images.in_place(ImageName::scattered, ImageName::light))) ||
      (writes_result && !images.in_place(ImageName::result, ImageName::beauty)) ||
      options.bad_pixels == BadPixels::zero;
  bool defers = plan.always_defers() || has_reuse;
  for (const ImageName input :
       {ImageName::light, ImageName::albedo, ImageName::depth, ImageName::mask, ImageName::matte}) {
    defers = defers || images.output_over(input);
  }
  params::RunFlags flags{};
  flags.writes_scattered = writes_scattered ? 1 : 0;
  flags.writes_result = writes_result ? 1 : 0;
  flags.zeroes_bad = options.bad_pixels == BadPixels::zero ? 1 : 0;
  flags.copies = copies ? 1 : 0;
  flags.skips = options.skip_uniform_light && !options.sums_weights ? 1 : 0;
  flags.defers = defers ? 1 : 0;
  flags.reuses = follows ? 1 : 0;
  return flags;
}

}  // namespace

FrameRun::FrameRun(const Plan::State& plan, const Frame& frame, const Band& band, const BoundImages& images,
                   RunMemory& memory, cl::CommandQueue queue, std::span<const cl_event> wait_for, Reuse::State* reuse)
    : plan_(plan),
      images_(images),
      memory_(memory),
      context_(plan.settings.device.context(), true),
      queue_(std::move(queue)),
      camera_(frame.camera),
      item_is_pixel_(plan.settings.item_is_pixel()),
      frame_(frame_params(frame, band, plan.settings.options, memory.sizes.frame)),
      window_(frame_window(memory.sizes.frame, plan.settings.has_pixel_width())),
      reuse_(plan.method->by_tiles() ? reuse : nullptr),
      flags_(run_flags(plan, images, reuse_ != nullptr, reuse_ != nullptr && reuse_->continues(plan, frame))) {
  for (const cl_event event : wait_for) last_.emplace_back(event, true);
  if (flags_.defers != 0 && reuse_ == nullptr) memory.need_deferred(plan.settings.device);
  deferred_ = cl::Buffer(reuse_ != nullptr    ? reuse_->deferred
                         : flags_.defers != 0 ? memory.deferred
                                              : memory.material_ids);
}

void FrameRun::launch(const cl::Kernel& kernel, const Grid& grid) {
  last_ = std::vector{enqueue(queue_, kernel, grid, last_)};
  phase_->push_back(last_.front());
}

void FrameRun::launch(const cl::Kernel& kernel, int columns, int rows, int local) {
  launch(kernel, local > 0 ? Grid{columns, rows, local, local} : Grid{columns, rows, group_line, 1});
}

void FrameRun::launch_runs(const cl::Kernel& kernel, int width, int rows) {
  launch(kernel, item_is_pixel_ ? width : 1, rows, local_size());
}

void FrameRun::include(const FrameRun& other) {
  last_.insert(last_.end(), other.last_.begin(), other.last_.end());
  for (const auto& events : {other.events_.classify, other.events_.scatter})
    phase_->insert(phase_->end(), events.begin(), events.end());
}

void FrameRun::classify() {
  find_blocks();
  if (memory_.sizes.has_curvature) make_entering_light();
  plan_.method->prepare(*this);
}

void FrameRun::find_blocks() {
  using enum ImageName;
  phase_ = &events_.classify;
  cl::Event cleared;
  queue_.enqueueFillBuffer(memory_.counters, cl_int{0}, 0, RUN_COUNTERS * sizeof(cl_int),
                           last_.empty() ? nullptr : &last_, &cleared);
  last_ = std::vector{cleared};
  const int blocks_per_item = run_length(frame_.blocks_x);
  cl::Kernel classify(plan_.classification, "classify_blocks");
  if (item_is_pixel_) {
    set_arguments(classify, frame_, images_.layouts(), images_.buffers({albedo, depth, material, mask, matte}),
                  plan_.materials, memory_.material_ids, memory_.blocks);
    launch(classify, {frame_.blocks_x * BLOCK, frame_.blocks_y * BLOCK, BLOCK, BLOCK});
  } else {
    set_arguments(classify, frame_, images_.layouts(), images_.buffers({albedo, depth, material, mask, matte}),
                  blocks_per_item, plan_.materials, memory_.material_ids, memory_.blocks);
    launch(classify, 1, frame_.blocks_y, 1);
  }
  cl::Kernel choose(plan_.classification, "choose_passes");
  set_arguments(choose, frame_, blocks_per_item, plan_.materials, plan_.levels, memory_.blocks, memory_.passes,
                memory_.counters);
  launch_runs(choose, frame_.blocks_x, frame_.blocks_y);
}

void FrameRun::make_entering_light() {
  using enum ImageName;
  cl::Kernel bend(program(), "curvature");
  set_arguments(bend, frame_, images_.layouts(), images_.buffers({depth, normal}), memory_.material_ids,
                run_length(frame_.width), memory_.curvature);
  launch_runs(bend, frame_.width, frame_.height);
  cl::Kernel enter(program(), "entering_light");
  set_arguments(enter, frame_, images_.layouts(), images_.buffers({light, albedo, mask}), memory_.material_ids,
                plan_.materials, plan_.curvatures, memory_.curvature, run_length(frame_.width), memory_.entering);
  launch_runs(enter, frame_.width, frame_.height);
}

params::FrameLayouts FrameRun::input_layouts() const {
  params::FrameLayouts layouts = images_.layouts();
  if (!memory_.sizes.has_curvature) return layouts;
  constexpr int bytes = sizeof(float);
  const int stride = size().stride();
  layouts.light = {.offset = params::Bytes{PADDING} * bytes,
                   .row_stride = static_cast<params::Bytes>(3 * bytes) * stride,
                   .pixel_stride = bytes,
                   .channel_stride = stride * bytes,
                   .format = FORMAT_F32,
                   .padding = 0};
  return layouts;
}

std::vector<cl::Buffer> FrameRun::inputs(std::initializer_list<ImageName> names) const {
  std::vector<cl::Buffer> buffers = images_.buffers(names);
  if (!memory_.sizes.has_curvature) return buffers;
  std::size_t i = 0;
  for (const ImageName name : names) {
    if (name == ImageName::light) buffers[i] = cl::Buffer(memory_.entering);
    ++i;
  }
  return buffers;
}

void FrameRun::scatter(int step) {
  phase_ = &events_.scatter;
  const int rows = plan_.method->rows_per_step(size());
  plan_.method->scatter(*this, {frame_.own_begin + step * rows, std::min(rows, own_rows().count - step * rows)});
}

std::vector<ViewStats> FrameRun::add_hidden_light(const Frame& frame) {
  phase_ = &events_.views;
  return plan_.hidden_light->add_to(*this, frame);
}

void FrameRun::finish() {
  phase_ = &events_.finish;
  plan_.method->finish(*this);
}

void FrameRun::compare_with_frame_before() {
  using enum ImageName;
  if (reuse_ == nullptr) return;
  const ProgramSource& source = plan_.sources.fingerprint;
  cl::Kernel kernel(build_program(plan_.settings.device, source.files, source.options), "fingerprint");
  set_arguments(kernel, frame_, input_layouts(), inputs({light, albedo, depth, material, mask, matte}), frame_.blocks_x,
                reuse_->fingerprints, flags_.reuses != 0 ? 0 : 1, reuse_->changed);
  launch(kernel, 1, frame_.blocks_y, 1);
}

void FrameRun::load_window(const cl::Buffer& window_memory) {
  using enum ImageName;
  const int stride = size().stride();
  cl::Kernel kernel(program(), "prepare");
  set_arguments(kernel, frame_, input_layouts(), inputs({light, albedo, depth, mask}), memory_.material_ids,
                plan_.materials, window_, window_memory, run_length(stride), memory_.counters);
  launch_runs(kernel, stride, frame_.height);
}

void FrameRun::write_deferred() {
  params::RunFlags flags = flags_;
  flags.copies = 1;
  write_deferred(flags, {}, memory_.material_ids);
}

void FrameRun::write_deferred(const params::TileParams& tiles, const cl::Buffer& kinds) {
  write_deferred(flags_, tiles, kinds);
}

void FrameRun::write_deferred(const params::RunFlags& flags, const params::TileParams& tiles, const cl::Buffer& kinds) {
  using enum ImageName;
  cl::Kernel kernel(program(), "finish");
  set_arguments(kernel, frame_, images_.layouts(), images_.buffers({light, albedo, matte, beauty, scattered, result}),
                flags, memory_.material_ids, memory_.passes, deferred_, tiles, kinds, run_length(frame_.width),
                memory_.counters);
  launch_runs(kernel, frame_.width, own_rows().count);
}

std::array<cl_int, RUN_COUNTERS> FrameRun::counters() const {
  std::array<cl_int, RUN_COUNTERS> counters{};
  queue_.enqueueReadBuffer(memory_.counters, CL_TRUE, 0, sizeof(counters), counters.data(), &last_);
  return counters;
}

void FrameRun::add_to(Stats& stats) const {
  const auto counted = counters();
  stats.pixels = static_cast<std::int64_t>(frame_.width) * own_rows().count;
  stats.pixels_scattered = counted[COUNTER_SCATTERED];
  stats.pixels_narrow = counted[COUNTER_NARROW];
  stats.pixels_without_material = stats.pixels - stats.pixels_scattered - stats.pixels_narrow;
  stats.pixels_flat = counted[COUNTER_FLAT];
  stats.channels_narrow = counted[COUNTER_CHANNELS];
  stats.pixels_bad = counted[COUNTER_BAD];
  stats.pixels_unlit = counted[COUNTER_UNLIT];
  stats.pixels_reached = counted[COUNTER_REACHED];
  plan_.method->add_to(stats, *this);
}

}  // namespace dermis
