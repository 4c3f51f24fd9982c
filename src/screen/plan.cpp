#include "dermis/plan.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <string>
#include <utility>

#include "dermis/tap_tables.hpp"
#include "opencl/command_chain.hpp"
#include "opencl/program.hpp"
#include "screen/check_materials.hpp"
#include "screen/curvature.hpp"
#include "screen/frame_images.hpp"
#include "screen/frame_run.hpp"
#include "screen/material_tables.hpp"
#include "screen/methods/disc_tables.hpp"
#include "screen/plan_state.hpp"
#include "screen/run_frame.hpp"
#include "taps/check_design.hpp"
#include "views/hidden_light.hpp"

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
  if (options.device_memory_mb < 0 || options.device_memory_mb > 1000000) {
    throw Error(ErrorCode::usage, "device_memory_mb", std::to_string(options.device_memory_mb), "0..1000000");
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

void check_sums(const FrameDescription& frames, const Options& options) {
  if (options.sums_weights && frames.views) {
    throw Error(ErrorCode::usage, "sums_weights", "it with views", "one of the two");
  }
}

/// Checks all that a plan is made of, and chooses its taps.
PlanSettings settings_of(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
                         const Options& options) {
  check_options(options);
  check_materials(materials, frames.material, frames.albedo);
  check_albedo_mix(frames, options);
  check_designs(materials, options);
  check_disc(options.disc);
  check_sums(frames, options);
  ChosenTaps choice = choose_taps(std::move(materials), options);
  return {device, std::move(choice.materials), frames, std::move(choice.options)};
}

/// Fits the taps, and tells the method of them.
MaterialTables fit_taps(const PlanSettings& settings, ScatterMethod& method, int terms) {
  MaterialTables tables = make_material_tables(
      settings, [&](const Material& material) { return method.design_of(material); }, terms);
  method.measure(tables);
  return tables;
}

/// Runs a plan on one black pixel. PoCL compiles a kernel when it is first launched, for the size of its
/// work-groups: here instead of in the first frame.
void run_on_black(const Plan& plan, const FrameDescription& frames) {
  const std::array<float, 3> in{};
  std::array<float, 3> out{};
  plan.run(one_pixel_frame(frames, in.data(), out.data()));
}

}  // namespace

std::unique_ptr<Plan::State> build_plan(PlanSettings its_settings) {
  auto state = std::make_unique<Plan::State>(std::move(its_settings));
  const PlanSettings& settings = state->settings;
  ScatterMethod& method = *state->method;
  const cl::Context context(settings.device.context(), true);
  const int terms = method.most_terms();
  state->sources = plan_programs(settings, method, terms);
  // The kernels are built while the taps are fitted.
  const auto build = [&](const ProgramSource& source) {
    return std::async(std::launch::async, [&] { return build_program(settings.device, source.files, source.options); });
  };
  auto program = build(state->sources.method);
  auto classification = build(state->sources.classification);
  std::vector<std::future<cl::Program>> more;
  for (const ProgramSource& its : state->sources.more) more.push_back(build(its));
  const MaterialTables tables = fit_taps(settings, method, terms);
  state->materials = upload(context, tables.materials);
  state->levels = upload(context, tables.levels);
  if (settings.has_curvature()) {
    std::vector<params::CurvatureParams> curvatures;
    for (const Material& its : settings.materials) curvatures.push_back(curvature_of(its.profile));
    state->curvatures = upload(context, curvatures);
  }
  method.upload(context, tables);
  state->classification = classification.get();
  state->program = program.get();
  for (auto& its : more) state->more_programs.push_back(its.get());
  if (settings.frames.views) state->hidden_light = std::make_shared<const HiddenLight>(settings);
  return state;
}

Plan::Plan(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
           const Options& options) {
  PlanSettings settings = settings_of(device, std::move(materials), frames, options);
  const bool compiles_at_launch = !settings.item_is_pixel();
  state_ = with_device_errors([&] { return build_plan(std::move(settings)); });
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
  const auto images = check_frame(frame, state_->settings.frames, state_->settings.options);
  check_views(frame, state_->settings);
  return with_device_errors([&] { return run_frame(*state_, frame, images, reuse, progress); });
}

Event Plan::enqueue(const Frame& frame, cl_command_queue queue, std::span<const cl_event> wait_for) const {
  const auto images = check_frame(frame, state_->settings.frames, state_->settings.options);
  check_enqueued(queue, images);
  if (!frame.views.empty()) {
    throw Error(ErrorCode::usage, "views", std::to_string(frame.views.size()) + " views",
                "none, as enqueue cannot wait for them");
  }
  if (state_->settings.options.bad_pixels == BadPixels::error) {
    throw Error(ErrorCode::usage, "bad_pixels", "error", "keep or zero, as enqueue cannot wait for the count");
  }
  check_memory(*state_, {frame.width, frame.height});
  return with_device_errors([&] {
    const Device& device = state_->settings.device;
    const cl::CommandQueue its_queue(queue, true);
    const BoundImages bound(device, its_queue, frame, images);
    auto lent = state_->memories.take_in_turn(device, state_->run_sizes(frame.width, frame.height));
    std::vector<cl_event> after(wait_for.begin(), wait_for.end());
    if (lent.used_until() != nullptr) after.push_back(lent.used_until());
    FrameRun frame_run(*state_, frame, Band::whole(frame.height), bound, *lent.memory, its_queue, after);
    frame_run.classify();
    for (int step = 0; step < frame_run.scatter_steps(); ++step) frame_run.scatter(step);
    frame_run.finish();
    its_queue.flush();
    lent.used_until = frame_run.last_event();
    cl::Event last = lent.used_until;
    state_->memories.give_back(std::move(lent));
    return dermis::Event(std::exchange(last(), nullptr));
  });
}

const Options& Plan::options() const { return state_->settings.options; }

MaterialTaps Plan::taps_of(std::size_t material, double pixel_mm) const {
  constexpr double usual_radius_px = 64;
  if (state_->settings.options.method != Method::separable) {
    throw Error(ErrorCode::usage, "method", name_of(state_->settings.options.method),
                "separable, for the others have no taps");
  }
  if (material >= state_->settings.materials.size()) {
    throw Error(ErrorCode::usage, "material", std::to_string(material), "one of the plan, from 0");
  }
  const Profile& profile = state_->settings.materials[material].profile;
  MaterialTaps result{.design = with_rank(state_->settings, profile, *state_->settings.materials[material].taps)};
  result.count = result.design.count;
  const auto taps = fitted_taps(state_->settings, profile, result.design);
  if (pixel_mm == 0) pixel_mm = taps->radius_mm / usual_radius_px;
  if (result.design.tolerance > 0) {
    const int level = Taps::level_index(static_cast<float>(taps->radius_mm / pixel_mm));
    result.count = level < 0 ? 1 : 2 * static_cast<int>(taps->levels[level].offsets_px.size()) + 1;
  }
  TapsDesign there = result.design;
  there.tolerance = 0;
  there.count = std::max(result.count, 3);  // narrow kernels have fewer taps than any design
  result.predicted_rel_l2 = make_tap_set(profile, there, pixel_mm).predicted_rel_l2;
  return result;
}

std::size_t Plan::scratch_bytes(int width, int height) const { return state_->scratch_bytes(width, height); }

std::size_t Plan::scratch_bytes(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
                                const Options& options, int width, int height) {
  const State state(settings_of(device, std::move(materials), frames, options));
  fit_taps(state.settings, *state.method, state.method->most_terms());
  return state.scratch_bytes(width, height);
}

}  // namespace dermis
