// Frame after frame through one plan: no buffer and no queue is made once it is warm, and frames that are on their way
// at the same time do not spoil each other.
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/counted_calls.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Options;
using dermis::Plan;

namespace {

constexpr int width = 61;
constexpr int height = 43;
constexpr std::size_t values = 3UL * width * height;

/// Light for some frames, and what it becomes on a plane of a pixel to a sixth of a millimetre.
struct Sequence {
  std::vector<std::vector<float>> light, scattered;

  explicit Sequence(int frames) {
    Random random(7101);
    for (int i = 0; i < frames; ++i) {
      std::vector<float>& its = light.emplace_back(values);
      for (float& value : its) value = static_cast<float>(random.uniform(0, 4));
      scattered.emplace_back(values);
    }
  }

  static Frame frame() {
    return {.width = width, .height = height, .camera = dermis::Camera::orthographic(6, 6), .mm_per_unit = 1};
  }

  Frame on_host(std::size_t i) {
    Frame its = frame();
    its.light.host = light[i].data();
    its.scattered.host = scattered[i].data();
    return its;
  }
};

Plan plan_on(const Device& device, dermis::Method method) {
  Options options{.taps = {.rank = 2, .count = 9}};
  options.method = method;
  return Plan(device, {{.profile = dermis::preset("skin").profile}}, {}, options);
}

}  // namespace

TEST_CASE("a warm plan makes no buffers and no queues", "[plan][many]") {
  const auto method = GENERATE(dermis::Method::separable, dermis::Method::exact, dermis::Method::disc);
  const bool on_gpu = GENERATE(false, true);
  const Device opened = Device::open();
  const Device device = on_gpu ? with_kernel_shape(opened, 1, "GPU") : opened;
  const Plan plan = plan_on(device, method);
  constexpr int frames = 10;
  Sequence sequence(frames);
  for (std::size_t i = 0; i < frames; ++i) plan.run(sequence.on_host(i));
  CHECK(sequence.scattered.front() != sequence.light.front());

  const cl::Context context(device.context(), true);
  const cl::CommandQueue queue(context, cl::Device(device.id(), true), CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  std::vector<cl::Buffer> light, scattered;
  for (std::size_t i = 0; i < frames; ++i) {
    light.emplace_back(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, values * sizeof(float),
                       sequence.light[i].data());
    scattered.emplace_back(context, CL_MEM_WRITE_ONLY, values * sizeof(float));
  }
  const auto enqueue = [&](std::size_t i) {
    Frame frame = Sequence::frame();
    frame.light.buffer = light[i]();
    frame.scattered.buffer = scattered[i]();
    return plan.enqueue(frame, queue());
  };
  std::vector<dermis::Event> events;
  events.push_back(enqueue(0));
  const MadeObjects before = made_objects();
  for (std::size_t i = 1; i < frames; ++i) events.push_back(enqueue(i));
  CHECK(made_objects() == before);
  for (const dermis::Event& event : events) event.wait();
  for (std::size_t i = 0; i < frames; ++i) {
    std::vector<float> result(values);
    queue.enqueueReadBuffer(scattered[i], CL_TRUE, 0, values * sizeof(float), result.data());
    CAPTURE(i, on_gpu);
    CHECK(result == sequence.scattered[i]);
  }
}

TEST_CASE("runs of frames on a device with memory of its own copy into the same buffers", "[plan][many]") {
  const Device device = with_kernel_shape(Device::open(), 1, "GPU");
  const Plan plan = plan_on(device, dermis::Method::separable);
  Sequence sequence(3);
  plan.run(sequence.on_host(0));
  const MadeObjects before = made_objects();
  plan.run(sequence.on_host(1));
  plan.run(sequence.on_host(2));
  CHECK(made_objects() == before);
}
