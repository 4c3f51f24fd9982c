#include "core/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace dermis {

namespace {

constexpr int rows_per_exact_step_px = 16;  ///< where a work-item is one pixel

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

template <class... Arguments>
void set_arguments(cl::Kernel& kernel, const Arguments&... arguments) {
  cl_uint index = 0;
  (kernel.setArg(index++, arguments), ...);
}

params::FrameParams frame_params(const Frame& frame, const Options& options, const WorkingSize& size) {
  const Camera& camera = frame.camera;
  const bool perspective = camera.projection == Camera::Projection::perspective;
  params::FrameParams p{};
  p.width = frame.width;
  p.height = frame.height;
  p.stride = size.stride;
  p.spans = size.spans;
  p.tile_width = options.tile_width;
  p.tile_height = options.tile_height;
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
  return p;
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

WorkingSize::WorkingSize(int width, int height, const Options& options)
    : stride(round_up(width, SPAN) + 2 * PADDING),
      plane(static_cast<std::size_t>(stride) * height),
      spans(round_up(width, SPAN) / SPAN),
      tiles_x(round_up(width, options.tile_width) / options.tile_width),
      tiles_y(round_up(height, options.tile_height) / options.tile_height) {}

std::size_t WorkingSize::bytes(int width, int height, int terms, bool has_pixel_width) const {
  // light and scattered have three planes, between three per term, depth one, segments two; width factors are three
  // more.
  const std::size_t planes = 3 + 3 * static_cast<std::size_t>(terms) + 3 + 1 + 2 + (has_pixel_width ? 3 : 0);
  const std::size_t floats = planes * plane + static_cast<std::size_t>(spans) * height * 2;
  const std::size_t tiles = static_cast<std::size_t>(tiles_x) * tiles_y;
  return floats * sizeof(float) + plane + static_cast<std::size_t>(width) * height +
         tiles * (1 + COUNTERS * sizeof(int));
}

Passes::Passes(const Plan::State& plan, const Frame& frame, const BoundImages& images, cl::CommandQueue queue,
               std::span<const cl_event> wait_for)
    : plan_(plan),
      images_(images),
      queue_(std::move(queue)),
      size_(frame.width, frame.height, plan.options),
      params_(frame_params(frame, plan.options, size_)) {
  for (const cl_event event : wait_for) last_.emplace_back(event, true);
  const cl::Context context(plan.device.context(), true);
  const auto allocate = [&](std::size_t bytes) { return cl::Buffer(context, CL_MEM_READ_WRITE, bytes); };
  const std::size_t plane_bytes = size_.plane * sizeof(float);
  const std::size_t largest_bytes = 3 * plane_bytes * plan.terms_per_material;
  if (largest_bytes > plan.device.info().max_buffer_bytes) {
    throw Error(ErrorCode::device, "frame size", std::to_string(largest_bytes) + " bytes for one working image",
                "at most " + std::to_string(plan.device.info().max_buffer_bytes) + " on this device");
  }
  const std::size_t tiles = static_cast<std::size_t>(size_.tiles_x) * size_.tiles_y;
  light_ = allocate(3 * plane_bytes);
  depth_ = allocate(plane_bytes);
  material_ = allocate(size_.plane);
  width_ = plan.has_pixel_width ? allocate(3 * plane_bytes) : depth_;
  bad_ = allocate(static_cast<std::size_t>(frame.width) * frame.height);
  footprint_ = allocate(static_cast<std::size_t>(size_.spans) * frame.height * 2 * sizeof(float));
  tile_class_ = allocate(tiles);
  counters_ = allocate(tiles * COUNTERS * sizeof(int));
  segment_ = allocate(2 * plane_bytes);
  between_ = allocate(largest_bytes);
  scattered_ = allocate(3 * plane_bytes);
  if (plan.options.jitter > 0) {
    auto table = rotations(frame.camera);
    rotations_ = cl::Buffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, sizeof(table), table.data());
  } else {
    rotations_ = plan.offsets;
  }
}

cl::Event Passes::launch(cl::Kernel& kernel, int columns, int rows) {
  cl::Event event;
  const cl::NDRange local = plan_.item_is_tile ? cl::NDRange(1, 1) : cl::NullRange;
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(columns, rows), local,
                              last_.empty() ? nullptr : &last_, &event);
  last_ = {event};
  return event;
}

void Passes::prepare_and_classify() {
  const int columns = plan_.item_is_tile ? size_.tiles_x : params_.width;
  const int rows = plan_.item_is_tile ? size_.tiles_y : params_.height;
  cl::Kernel prepare(plan_.program, "prepare");
  set_arguments(prepare, params_, plan_.materials,                                         //
                images_.buffer(ImageName::light), images_.layout(ImageName::light),        //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),      //
                images_.buffer(ImageName::depth), images_.layout(ImageName::depth),        //
                images_.buffer(ImageName::material), images_.layout(ImageName::material),  //
                images_.buffer(ImageName::mask), images_.layout(ImageName::mask),          //
                light_, depth_, material_, width_, bad_);
  events_.prepare = launch(prepare, columns, rows);
  cl::Kernel classify(plan_.program, "classify");
  set_arguments(classify, params_, plan_.materials, depth_, material_, width_, bad_, footprint_, tile_class_,
                counters_);
  events_.classify = launch(classify, size_.tiles_x, size_.tiles_y);
  const bool exact = plan_.options.method == Method::exact;
  cl::Kernel tangents(plan_.program, exact ? "slopes" : "segments");
  set_arguments(tangents, params_, depth_, material_, exact ? between_ : segment_);
  events_.scatter.push_back(launch(tangents, columns, rows));
}

int Passes::scatter_steps() const {
  if (plan_.options.method == Method::separable) return 1;
  return plan_.item_is_tile ? size_.tiles_y : round_up(params_.height, rows_per_exact_step_px) / rows_per_exact_step_px;
}

void Passes::scatter(int step) {
  if (plan_.options.method == Method::separable) {
    launch_separable();
  } else if (plan_.item_is_tile) {
    launch_exact(step, 1);
  } else {
    const int first_row = step * rows_per_exact_step_px;
    launch_exact(first_row, std::min(rows_per_exact_step_px, params_.height - first_row));
  }
}

void Passes::launch_separable() {
  const int columns = plan_.item_is_tile ? size_.tiles_x : params_.width;
  const int rows = plan_.item_is_tile ? size_.tiles_y : params_.height;
  const auto pass = [&](const char* name, const cl::Buffer& from, const cl::Buffer& to) {
    cl::Kernel kernel(plan_.program, name);
    set_arguments(kernel, params_, 0, plan_.materials, plan_.terms, plan_.rungs, plan_.offsets, plan_.weights,
                  plan_.nodes, rotations_, plan_.options.seed, from, depth_, segment_, material_, width_, footprint_,
                  tile_class_, to);
    events_.scatter.push_back(launch(kernel, columns, rows));
  };
  pass("scatter_x", light_, between_);
  pass("scatter_y", between_, scattered_);
}

void Passes::launch_exact(int first_row, int rows) {
  cl::Kernel kernel(plan_.program, "exact");
  set_arguments(kernel, params_, first_row, plan_.materials, plan_.terms, plan_.nodes, light_, depth_, material_,
                width_, between_, tile_class_, scattered_);
  events_.scatter.push_back(launch(kernel, plan_.item_is_tile ? size_.tiles_x : params_.width, rows));
}

void Passes::finish() {
  cl::Kernel kernel(plan_.program, "finish");
  const int has_scattered = images_.has(ImageName::scattered) ? 1 : 0;
  const int has_result = images_.has(ImageName::result) ? 1 : 0;
  set_arguments(kernel, params_, light_, scattered_, material_,                        //
                images_.buffer(ImageName::light), images_.layout(ImageName::light),    //
                images_.buffer(ImageName::albedo), images_.layout(ImageName::albedo),  //
                images_.buffer(ImageName::beauty), images_.layout(ImageName::beauty),  //
                images_.buffer(ImageName::scattered), images_.layout(ImageName::scattered), has_scattered,
                images_.buffer(ImageName::result), images_.layout(ImageName::result), has_result);
  events_.finish = launch(kernel, plan_.item_is_tile ? size_.tiles_x : params_.width,
                          plan_.item_is_tile ? size_.tiles_y : params_.height);
}

std::vector<int> Passes::tile_counters() const {
  std::vector<int> counters(static_cast<std::size_t>(size_.tiles_x) * size_.tiles_y * COUNTERS);
  queue_.enqueueReadBuffer(counters_, CL_TRUE, 0, counters.size() * sizeof(int), counters.data());
  return counters;
}

}  // namespace dermis
