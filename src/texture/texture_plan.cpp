#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "opencl/device.hpp"
#include "opencl/device_cache.hpp"
#include "texture/texture_scatter.hpp"

namespace dermis {

struct TexturePlan::State {
  Device device;
  TextureDescription description;
  TextureOptions options;
  std::unique_ptr<const TextureScatter> method;
};

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

}  // namespace

TexturePlan::TexturePlan(const Device& device, const Profile& profile, const TextureDescription& frames,
                         const TextureOptions& options) {
  check_plan(profile, frames, options);
  const auto make = options.method == TextureMethod::recursive ? make_texture_recursion : make_texture_blur;
  auto method = with_device_errors([&] { return make(device, profile, frames); });
  state_ = std::make_unique<const State>(State{device, frames, options, std::move(method)});
}

TexturePlan::~TexturePlan() = default;
TexturePlan::TexturePlan(TexturePlan&&) noexcept = default;
TexturePlan& TexturePlan::operator=(TexturePlan&&) noexcept = default;

TextureStats TexturePlan::run(const TextureFrame& frame) const {
  const auto start = std::chrono::steady_clock::now();
  const auto images = check_texture(frame, state_->description);
  return with_device_errors([&] {
    const BorrowedQueue queue(state_->device);
    const TextureBuffers buffers(state_->device, *queue, frame, images);
    const TextureScatter& method = *state_->method;
    CommandChain commands(*queue);
    TextureRun run(state_->device, commands, method.image_program(), frame, buffers, state_->options.albedo_mix);
    TextureStats stats = method.scatter(run);
    stats.total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return stats;
  });
}

Event TexturePlan::enqueue(const TextureFrame& frame, cl_command_queue queue,
                           std::span<const cl_event> wait_for) const {
  const auto images = check_texture(frame, state_->description);
  check_enqueued(queue, images);
  return with_device_errors([&] {
    CommandChain commands(cl::CommandQueue(queue, true), wait_for);
    const TextureBuffers buffers(state_->device, commands.queue(), frame, images);
    const TextureScatter& method = *state_->method;
    TextureRun run(state_->device, commands, method.image_program(), frame, buffers, state_->options.albedo_mix);
    method.enqueue(run);
    return commands.hand_over();
  });
}

double TexturePlan::predicted_rel_l2() const { return state_->method->predicted_rel_l2(); }

}  // namespace dermis
