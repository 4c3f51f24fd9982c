#include <chrono>
#include <memory>
#include <sstream>
#include <string>

#include "opencl/device.hpp"
#include "opencl/program.hpp"
#include "texture/texture_run.hpp"

namespace dermis {

namespace {

void check_plan(const Profile& profile, const TextureDescription& frames, const TextureOptions& options) {
  if (!(options.albedo_mix >= 0 && options.albedo_mix <= 1)) {
    throw Error(ErrorCode::usage, "albedo_mix", std::to_string(options.albedo_mix), "0..1");
  }
  if (options.albedo_mix > 0 && !frames.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image", "an albedo image for albedo_mix above 0");
  }
  if (profile.width_follows_albedo()) {
    throw Error(ErrorCode::usage, "profile", "one whose width follows the albedo", "one of the same width everywhere");
  }
}

std::string build_options(const TexturePlan::State& state, const TextureDescription& images) {
  std::ostringstream options;
  options << std::scientific << "-cl-std=CL1.2 -DLIT=0 -DV=" << state.vector_width
          << " -DRECURSIVE=" << state.is_recursive() << " -DHAS_ALBEDO=" << images.albedo
          << " -DHAS_MASK=" << images.mask << " -DHAS_STRETCH=" << images.stretch
          << " -DSPACING=" << GaussianChain::spacing << "f -DREACH=" << GaussianChain::reach
          << "f -DNARROW=" << GaussianChain::narrow << "f -DMOST_TEXELS=" << GaussianChain::most_texels << "f";
  return options.str();
}

void build(TexturePlan::State& state) {
  state.image_program = build_program(state.device, {"texture/texture_prepare.cl", "texture/texture_finish.cl"},
                                      build_options(state, state.description));
  // The passes do not see albedo and mask, and are the same with and without. Where there is no light the states of a
  // recursion fade away, for which numbers below the normal ones are slow.
  state.pass_program =
      build_program(state.device, {state.is_recursive() ? "texture/recursion.cl" : "texture/texture_blur.cl"},
                    build_options(state, {.stretch = state.description.stretch}) + " -cl-denorms-are-zero");
}

}  // namespace

TexturePlan::TexturePlan(const Device& device, const Profile& profile, const TextureDescription& frames,
                         const TextureOptions& options) {
  check_plan(profile, frames, options);
  auto state = std::make_unique<State>(device);
  state->description = frames;
  state->options = options;
  state->vector_width = device.info().vector_width;
  if (state->is_recursive()) {
    state->recursion = make_recursion(profile);
  } else {
    state->chain = make_gaussian_chain(profile);
  }
  with_device_errors([&] { build(*state); });
  state_ = std::move(state);
}

TexturePlan::~TexturePlan() = default;
TexturePlan::TexturePlan(TexturePlan&&) noexcept = default;
TexturePlan& TexturePlan::operator=(TexturePlan&&) noexcept = default;

TextureStats TexturePlan::run(const TextureFrame& frame) const {
  const auto start = std::chrono::steady_clock::now();
  const auto images = check_texture(frame, state_->description);
  return with_device_errors([&] {
    const cl::Context context(state_->device.context(), true);
    const cl::CommandQueue queue(context, cl::Device(state_->device.id(), true), CL_QUEUE_PROFILING_ENABLE);
    const TextureBuffers buffers(context, frame, images);
    // Whatever ends the run, the device must be done with the caller's memory first.
    const BorrowedMemory<TextureMemory> memory(state_->memories, context, queue,
                                               {frame.width, frame.height, state_->is_recursive()});
    TextureRun run(*state_, frame, buffers, *memory, queue);
    run.prepare();
    run.scatter();
    run.finish();
    buffers.read_back(queue);
    TextureStats stats;
    run.add_to(stats);
    stats.total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return stats;
  });
}

double TexturePlan::predicted_rel_l2() const {
  return state_->is_recursive() ? state_->recursion.predicted_rel_l2 : state_->chain.predicted_rel_l2;
}

}  // namespace dermis
