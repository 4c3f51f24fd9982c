#include "dermis/plan.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <sstream>
#include <string>

#include "opencl/program.hpp"
#include "screen/check_materials.hpp"
#include "screen/disc_tables.hpp"
#include "screen/frame_images.hpp"
#include "screen/material_tables.hpp"
#include "screen/passes.hpp"
#include "screen/plan_state.hpp"
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
  if (options.tile_width < 0 || options.tile_width % BLOCK != 0 || options.tile_width > largest_tile_px) {
    throw Error(ErrorCode::usage, "tile_width", std::to_string(options.tile_width), "a multiple of 16 up to 65536");
  }
  if (options.tile_height < 0 || options.tile_height > largest_tile_px) {
    throw Error(ErrorCode::usage, "tile_height", std::to_string(options.tile_height), "0..65536");
  }
}

void check_disc(const DiscOptions& disc) {
  const auto check = [](int value, const char* argument, int least, int most) {
    if (value < least || value > most) {
      throw Error(ErrorCode::usage, argument, std::to_string(value),
                  std::to_string(least) + ".." + std::to_string(most));
    }
  };
  check(disc.samples, "disc samples", 0, most_disc_samples);
  check(disc.accumulate, "disc accumulate", 1, 1 << 16);
}

void check_designs(const std::vector<Material>& materials, const Options& options) {
  check_design(options.taps);
  for (const Material& material : materials) {
    if (material.taps) check_design(*material.taps);
  }
}

void check_albedo_mix(const FrameDescription& frames, const Options& options) {
  if (options.albedo_mix > 0 && !frames.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image", "an albedo image for albedo_mix above 0");
  }
}

/// What all kernels are built with.
std::string common_options(const Plan::State& state, int materials) {
  const FrameDescription& frames = state.description;
  std::ostringstream bounds;
  bounds << std::scientific << " -DFLATNESS=" << Taps::flatness << "f -DSMOOTHNESS=" << Taps::smoothness
         << "f -DMOST_STRETCH=" << Taps::most_stretch << "f -DMOST_SKEW=" << Taps::most_skew << "f";
  return "-cl-std=CL1.2" + build_constant("MATERIALS", materials) + build_constant("HAS_DEPTH", frames.depth ? 1 : 0) +
         build_constant("HAS_MATERIAL", frames.material ? 1 : 0) + build_constant("HAS_MASK", frames.mask ? 1 : 0) +
         build_constant("HAS_ALBEDO", frames.albedo ? 1 : 0) + build_constant("HAS_MATTE", frames.matte ? 1 : 0) +
         build_constant("PIXEL_WIDTH", state.has_pixel_width ? 1 : 0) +
         build_constant("JITTER", state.options.jitter > 0 ? 1 : 0) +
         build_constant("SHEARED", state.is_sheared ? 1 : 0) + bounds.str();
}

/// Samples of a disc lie anywhere, so that its pixels are computed one by one.
int vector_width(const Plan::State& state) {
  return state.item_is_pixel || state.options.method == Method::disc ? 1 : state.device.info().vector_width;
}

/// Every program costs PoCL 25 ms from its cache on disk, and 200 ms without, for headers and the library of built-in
/// functions: all kernels are in one if they have vectors of the same width.
bool is_one_program(const Plan::State& state) { return vector_width(state) == BLOCK; }

/// The files of a method that works on windows that are the frame.
std::vector<std::string> files_of(Method method) {
  switch (method) {
    case Method::exact:
      return {"frame/prepare.cl", "integral/exact.cl"};
    case Method::disc:
      return {"frame/prepare.cl", "integral/disc_texels.cl", "integral/disc.cl"};
    case Method::separable:
      break;
  }
  return {"frame/prepare.cl", "separable/pixel.cl"};
}

cl::Program build_classification(const Plan::State& state) {
  return build_program(state.device, {"classify/classify.cl"}, state.build_options + build_constant("V", BLOCK));
}

/// The passes, and the classification too if they are in one program.
cl::Program build_passes(const Plan::State& state) {
  std::vector<std::string> files = {"frame/finish.cl"};
  if (state.tiled) {
    files.emplace_back("separable/tile.cl");
  } else {
    for (const std::string& file : files_of(state.options.method)) files.push_back(file);
  }
  if (is_one_program(state)) files.emplace_back("classify/classify.cl");
  return build_program(state.device, files,
                       state.build_options + build_constant("V", vector_width(state)) +
                           build_constant("TERMS", state.terms_per_material) +
                           build_constant("TILED", state.tiled ? 1 : 0) +
                           build_constant("LIT", state.options.lighting == Lighting::lit ? 1 : 0) +
                           build_constant("TANGENT_DISC", state.options.disc.tangent_plane ? 1 : 0) +
                           build_constant("HAS_NORMAL", state.description.normal ? 1 : 0) +
                           build_constant("TABLE_SHIFT", 23 - log2_nodes_per_octave_of_exact));
}

/// Runs a plan on one black pixel. PoCL compiles a kernel when it is first launched, for the size of its
/// work-groups: here instead of in the first frame.
void run_on_black(const Plan& plan, const FrameDescription& frames) {
  const std::array<float, 3> in{};
  std::array<float, 3> out{};
  const Image image{.host = in.data()};
  const Image none;
  Frame frame{.width = 1,
              .height = 1,
              .light = image,
              .albedo = frames.albedo ? image : none,
              .depth = frames.depth ? image : none,
              .material = frames.material ? image : none,
              .mask = frames.mask ? image : none,
              .matte = frames.matte ? image : none,
              .normal = frames.normal ? image : none,
              .camera = Camera::orthographic(1, 1),
              .scattered = {.host = out.data()}};
  plan.run(frame);
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

Plan::Plan(const Device& device, std::vector<Material> given_materials, const FrameDescription& frames,
           const Options& given_options) {
  check_options(given_options);
  check_materials(given_materials, frames.material, frames.albedo);
  check_albedo_mix(frames, given_options);
  check_designs(given_materials, given_options);
  check_disc(given_options.disc);
  auto state = std::make_unique<State>(device);
  state->description = frames;
  ChosenTaps choice = choose_taps(std::move(given_materials), given_options);
  state->options = std::move(choice.options);
  state->chosen = std::move(choice.materials);
  const Options& options = state->options;
  const std::vector<Material>& materials = state->chosen;
  state->has_pixel_width = frames.mask || any_follows_albedo(materials);
  state->is_sheared = frames.depth && options.sheared && options.jitter == 0;
  state->item_is_pixel = device.info().type == "GPU";
  state->tiled = !state->item_is_pixel && options.method == Method::separable;
  state->build_options = common_options(*state, static_cast<int>(materials.size()));
  with_device_errors([&] {
    const cl::Context context(device.context(), true);
    // The kernels are built while the taps are fitted.
    state->terms_per_material = most_terms(device, materials, options);
    const auto async = [&](auto build) {
      return std::async(std::launch::async, [&, build] { return build(*state); }).share();
    };
    const auto passes = async(build_passes);
    const auto classification = is_one_program(*state) ? passes : async(build_classification);
    const MaterialTables tables = make_material_tables(device, materials, options, state->terms_per_material);
    state->farthest_px = tables.farthest_px;
    state->materials = upload(context, tables.materials);
    state->terms = upload(context, tables.terms);
    state->levels = upload(context, tables.levels);
    state->offsets = upload(context, tables.offsets_px);
    state->weights = upload(context, tables.weights);
    state->flat_weights = upload(context, tables.flat_weights);
    state->smooth_weights = upload(context, tables.smooth_weights);
    state->nodes = upload(context, tables.nodes);
    state->discs = upload(context, tables.discs);
    state->samples = upload(context, tables.samples);
    state->classify_program = classification.get();
    state->program = passes.get();
  });
  const bool compiles_at_launch = !state->item_is_pixel;
  state_ = std::move(state);
  if (compiles_at_launch) run_on_black(*this, frames);
}

Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;

Stats Plan::run(const Frame& frame, const Progress& progress) const { return run(frame, nullptr, progress); }

Stats Plan::run(const Frame& frame, Reuse& reuse, const Progress& progress) const {
  return run(frame, reuse.state_.get(), progress);
}

Stats Plan::run(const Frame& frame, Reuse::State* reuse, const Progress& progress) const {
  const auto start = std::chrono::steady_clock::now();
  const auto milliseconds_since_start = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  };
  const auto images = check_frame(frame, state_->description, state_->options);
  const auto go_on = [&](double share) { return !progress || progress(share); };
  return with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue queue(context, cl::Device(state_->device.id(), true), CL_QUEUE_PROFILING_ENABLE);
    const BoundImages bound(context, frame, images);
    // Whatever ends the run, the device must be done with the caller's memory first.
    const BorrowedMemory<RunMemory> memory(state_->memories, context, queue,
                                           run_sizes(*state_, frame.width, frame.height));
    Passes passes(*state_, frame, bound, *memory, queue, {}, reuse);
    Stats stats;
    stats.prepare_ms = milliseconds_since_start();
    passes.classify();
    const int steps = passes.scatter_steps();
    for (int step = 0; step < steps; ++step) {
      passes.scatter(step);
      if (steps == 1 && !progress) break;
      queue.finish();
      if (!go_on((step + 1.0) / (steps + 1))) return Stats{};
    }
    if (state_->options.bad_pixels == BadPixels::error) {
      if (const int bad = passes.bad_pixels(); bad > 0) {
        throw Error(ErrorCode::input_unsupported, "light", std::to_string(bad) + " pixels that are not finite",
                    "finite light and albedo, or bad_pixels keep or zero");
      }
    }
    passes.finish();
    bound.read_back(queue);
    passes.add_to(stats);
    if (reuse != nullptr) reuse->plan = state_->number;
    stats.classify_ms = milliseconds(passes.events().classify);
    stats.scatter_ms = milliseconds(passes.events().scatter);
    stats.finish_ms = milliseconds(passes.events().finish);
    stats.total_ms = milliseconds_since_start();
    go_on(1);
    return stats;
  });
}

Event Plan::enqueue(const Frame& frame, cl_command_queue queue, std::span<const cl_event> wait_for) const {
  if (queue == nullptr) throw Error(ErrorCode::usage, "queue", "nullptr", "an OpenCL command queue");
  const auto images = check_frame(frame, state_->description, state_->options);
  for (const CallerImage& image : images) {
    if (image.host != nullptr) throw Error(ErrorCode::usage, image.name, "host memory", "a buffer, to enqueue");
  }
  if (state_->options.bad_pixels == BadPixels::error) {
    throw Error(ErrorCode::usage, "bad_pixels", "error", "keep or zero, as enqueue cannot wait for the count");
  }
  return with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue its_queue(queue, true);
    const BoundImages bound(context, frame, images);
    // The device keeps what it needs of it until it is done.
    RunMemory memory(context, run_sizes(*state_, frame.width, frame.height));
    Passes passes(*state_, frame, bound, memory, its_queue, wait_for);
    passes.classify();
    for (int step = 0; step < passes.scatter_steps(); ++step) passes.scatter(step);
    passes.finish();
    its_queue.flush();
    cl_event event = passes.last_event()();
    clRetainEvent(event);
    return dermis::Event(event);
  });
}

std::size_t Plan::scratch_bytes(int width, int height) const {
  return run_sizes(*state_, width, height).bytes(state_->options.bad_pixels == BadPixels::error);
}

}  // namespace dermis
