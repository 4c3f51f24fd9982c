#include "dermis/plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <string>

#include "core/frame_images.hpp"
#include "core/material_tables.hpp"
#include "core/passes.hpp"
#include "core/plan_state.hpp"
#include "core/program.hpp"
#include "taps/check_design.hpp"

namespace dermis {

namespace {

void check_share(double value, const char* argument) {
  if (!(value >= 0 && value <= 1)) throw Error(ErrorCode::usage, argument, std::to_string(value), "0..1");
}

void check_options(const Options& options) {
  constexpr int largest_tile_px = 1 << 16;
  check_share(options.jitter, "jitter");
  check_share(options.albedo_mix, "albedo_mix");
  if (options.tile_width < SPAN || options.tile_width % SPAN != 0 || options.tile_width > largest_tile_px) {
    throw Error(ErrorCode::usage, "tile_width", std::to_string(options.tile_width), "a multiple of 16 up to 65536");
  }
  if (options.tile_height < 1 || options.tile_height > largest_tile_px) {
    throw Error(ErrorCode::usage, "tile_height", std::to_string(options.tile_height), "1..65536");
  }
}

void check_designs(const std::vector<Material>& materials, const Options& options) {
  check_design(options.taps);
  for (const Material& material : materials) {
    if (material.taps) check_design(*material.taps);
  }
}

void check_materials(const std::vector<Material>& materials, const FrameDescription& frames, const Options& options) {
  const std::string count = std::to_string(materials.size());
  if (frames.material && (materials.empty() || materials.size() > MAX_MATERIALS)) {
    throw Error(ErrorCode::usage, "materials", count, "1.." + std::to_string(MAX_MATERIALS));
  }
  if (!frames.material && materials.size() != 1) {
    throw Error(ErrorCode::usage, "materials", count, "exactly 1, as the frames have no material ids");
  }
  std::set<int> ids;
  for (const Material& material : materials) {
    if (frames.material && (material.id < 0 || material.id > 65535 || !ids.insert(material.id).second)) {
      throw Error(ErrorCode::usage, "material id", std::to_string(material.id), "different ids in 0..65535");
    }
    if (material.profile.width_follows_albedo() && !frames.albedo) {
      throw Error(ErrorCode::role_missing, "albedo", "no image",
                  "an albedo image, which a profile takes its width from");
    }
  }
  if (options.albedo_mix > 0 && !frames.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image", "an albedo image for albedo_mix above 0");
  }
}

std::string build_options(const Plan::State& state, int materials, int log2_nodes_per_octave) {
  const auto define = [](const char* name, int value) {
    return std::string(" -D") + name + "=" + std::to_string(value);
  };
  const FrameDescription& frames = state.description;
  return "-cl-std=CL1.2" + define("V", state.item_is_tile ? state.device.info().vector_width : 1) +
         define("ITEM_IS_TILE", state.item_is_tile ? 1 : 0) + define("MATERIALS", materials) +
         define("TERMS", state.terms_per_material) + define("HAS_DEPTH", frames.depth ? 1 : 0) +
         define("HAS_MATERIAL", frames.material ? 1 : 0) + define("HAS_MASK", frames.mask ? 1 : 0) +
         define("HAS_ALBEDO", frames.albedo ? 1 : 0) + define("PIXEL_WIDTH", state.has_pixel_width ? 1 : 0) +
         define("LIT", state.options.lighting == Lighting::lit ? 1 : 0) +
         define("JITTER", state.options.jitter > 0 ? 1 : 0) + define("TABLE_SHIFT", 23 - log2_nodes_per_octave);
}

template <class Row>
cl::Buffer upload(const cl::Context& context, const std::vector<Row>& rows) {
  return {context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, rows.size() * sizeof(Row), const_cast<Row*>(rows.data())};
}

double milliseconds(const cl::Event& event) {
  const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  return static_cast<double>(end - start) * 1e-6;
}

struct FinishedAtEnd {
  const cl::CommandQueue& queue;
  ~FinishedAtEnd() { clFinish(queue()); }
};

Stats make_stats(const Passes& passes) {
  Stats stats;
  stats.prepare_ms = milliseconds(passes.events().prepare);
  stats.classify_ms = milliseconds(passes.events().classify);
  for (const cl::Event& event : passes.events().scatter) stats.scatter_ms += milliseconds(event);
  stats.finish_ms = milliseconds(passes.events().finish);
  const std::vector<int> counters = passes.tile_counters();
  for (std::size_t i = 0; i < counters.size(); i += COUNTERS) {
    const int scattered = counters[i + COUNT_SCATTERED];
    const int narrow = counters[i + COUNT_NARROW];
    ++stats.tiles;
    ++(scattered > 0 ? stats.tiles_computed : narrow > 0 ? stats.tiles_narrow : stats.tiles_without_material);
    stats.pixels_scattered += scattered;
    stats.pixels_narrow += narrow;
    stats.pixels_without_material += counters[i + COUNT_WITHOUT_MATERIAL];
    stats.pixels_bad += counters[i + COUNT_BAD];
  }
  stats.pixels = stats.pixels_scattered + stats.pixels_narrow + stats.pixels_without_material + stats.pixels_bad;
  return stats;
}

}  // namespace

Event::Event(cl_event adopted) : event_(adopted) {}

Event::~Event() {
  if (event_ != nullptr) clReleaseEvent(event_);
}

Event::Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}

Event& Event::operator=(Event&& other) noexcept {
  std::swap(event_, other.event_);
  return *this;
}

void Event::wait() const {
  with_device_errors([&] { cl::Event(event_, true).wait(); });
}

Plan::Plan(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
           const Options& options) {
  check_options(options);
  check_materials(materials, frames, options);
  check_designs(materials, options);
  const bool follows_albedo = std::any_of(materials.begin(), materials.end(),
                                          [](const Material& m) { return m.profile.width_follows_albedo(); });
  auto state = std::make_unique<State>(State{.device = device,
                                             .description = frames,
                                             .options = options,
                                             .program = {},
                                             .materials = {},
                                             .terms = {},
                                             .rungs = {},
                                             .offsets = {},
                                             .weights = {},
                                             .nodes = {},
                                             .terms_per_material = 1,
                                             .has_pixel_width = frames.mask || follows_albedo,
                                             .item_is_tile = device.info().type != "GPU"});
  const MaterialTables tables = make_material_tables(materials, options);
  state->terms_per_material = tables.terms_per_material;
  with_device_errors([&] {
    const cl::Context context(device.context(), true);
    state->materials = upload(context, tables.materials);
    state->terms = upload(context, tables.terms);
    state->rungs = upload(context, tables.rungs);
    state->offsets = upload(context, tables.offsets_px);
    state->weights = upload(context, tables.weights);
    state->nodes = upload(context, tables.nodes);
    state->program = build_program(
        context, cl::Device(device.id(), true),
        options.method == Method::separable
            ? std::vector<std::string>{"prepare.cl", "classify.cl", "segments.cl", "scatter.cl", "finish.cl"}
            : std::vector<std::string>{"prepare.cl", "classify.cl", "exact.cl", "finish.cl"},
        build_options(*state, static_cast<int>(materials.size()), tables.log2_nodes_per_octave));
  });
  state_ = std::move(state);
}

Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;

Stats Plan::run(const Frame& frame, const Progress& progress) const {
  const auto start = std::chrono::steady_clock::now();
  const auto images = check_frame(frame, state_->description, state_->options);
  const auto go_on = [&](double share) { return !progress || progress(share); };
  return with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue queue(context, cl::Device(state_->device.id(), true), CL_QUEUE_PROFILING_ENABLE);
    const BoundImages bound(context, frame, images);
    // Whatever ends the run, the device must be done with the caller's memory first.
    const FinishedAtEnd finished_at_end{queue};
    Passes passes(*state_, frame, bound, queue, {});
    passes.prepare_and_classify();
    const int steps = passes.scatter_steps();
    for (int step = 0; step < steps; ++step) {
      passes.scatter(step);
      queue.finish();
      if (!go_on((step + 1.0) / (steps + 1))) return Stats{};
    }
    passes.finish();
    bound.read_back(queue);
    Stats stats = make_stats(passes);
    stats.total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    go_on(1);
    return stats;
  });
}

Event Plan::enqueue(const Frame& frame, cl_command_queue queue, std::span<const cl_event> wait_for) const {
  if (queue == nullptr) throw Error(ErrorCode::usage, "queue", "nullptr", "an OpenCL command queue");
  const auto images = check_frame(frame, state_->description, state_->options);
  for (const FrameImage& image : images) {
    if (image.host != nullptr) throw Error(ErrorCode::usage, image.name, "host memory", "a buffer, to enqueue");
  }
  return with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue its_queue(queue, true);
    const BoundImages bound(context, frame, images);
    Passes passes(*state_, frame, bound, its_queue, wait_for);
    passes.prepare_and_classify();
    for (int step = 0; step < passes.scatter_steps(); ++step) passes.scatter(step);
    passes.finish();
    its_queue.flush();
    cl_event event = passes.events().finish();
    clRetainEvent(event);
    return dermis::Event(event);
  });
}

std::size_t Plan::scratch_bytes(int width, int height) const {
  return WorkingSize(width, height, state_->options)
      .bytes(width, height, state_->terms_per_material, state_->has_pixel_width);
}

}  // namespace dermis
