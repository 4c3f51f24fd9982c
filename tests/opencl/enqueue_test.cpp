// Textures and lights on a queue of the caller: the bits of a run, and nothing is allocated once the first frame is
// done.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/counted_calls.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Device;
using dermis::Event;

namespace {

constexpr int width = 71;
constexpr int height = 45;
constexpr std::size_t values = 3UL * width * height;

void put(dermis::Image& image, const float* at) { image.host = at; }
void put(dermis::Image& image, cl_mem at) { image.buffer = at; }
void put(dermis::OutputImage& image, float* at) { image.host = at; }
void put(dermis::OutputImage& image, cl_mem at) { image.buffer = at; }

/// Work on images of three channels: `run` from host memory, `enqueue` from buffers.
struct Work {
  std::function<void(const std::vector<const float*>& in, float* out)> run;
  std::function<Event(const std::vector<cl_mem>& in, cl_mem out, cl_command_queue queue, cl_event after)> enqueue;
};

/// Work of something with run and enqueue, on the frames that `frame_of` makes of the images' places.
template <class Filter, class FrameOf>
Work work_of(std::shared_ptr<const Filter> filter, FrameOf frame_of) {
  return {[=](const auto& in, float* out) { filter->run(frame_of(in, out)); },
          [=](const auto& in, cl_mem out, cl_command_queue queue, cl_event after) {
            return filter->enqueue(frame_of(in, out), queue, {&after, 1});
          }};
}

Work texture_work(const Device& device, dermis::TextureMethod method) {
  const auto plan = std::make_shared<const dermis::TexturePlan>(
      device, dermis::preset("skin").profile, dermis::TextureDescription{}, dermis::TextureOptions{.method = method});
  return work_of(plan, [](const auto& in, auto out) {
    dermis::TextureFrame frame{.width = width, .height = height, .mm_per_texel = 0.3};
    put(frame.light, in[0]);
    put(frame.scattered, out);
    return frame;
  });
}

std::vector<dermis::Light> some_lights() {
  return {{.direction = {0.2, 0.1, -1}, .colour = {1, 0.8, 0.5}},
          {.kind = dermis::Light::Kind::point, .position = {0, 1, 3}, .colour = {5, 4, 3}}};
}

Work shading_work(const Device& device) {
  const auto shading = std::make_shared<const dermis::Shading>(device);
  return work_of(shading, [lights = some_lights()](const auto& in, auto out) {
    dermis::ShadingFrame frame{.width = width, .height = height, .lights = lights};
    frame.viewer.place = {0, 0, 5};
    put(frame.position, in[0]);
    put(frame.normal, in[1]);
    put(frame.albedo, in[2]);
    put(frame.beauty, out);
    return frame;
  });
}

Work translucency_work(const Device& device) {
  const std::vector<dermis::Material> skin{{.profile = dermis::preset("skin").profile}};
  const auto translucency =
      std::make_shared<const dermis::Translucency>(device, skin, dermis::TranslucencyDescription{.thickness = true});
  return work_of(translucency, [lights = some_lights()](const auto& in, auto out) {
    dermis::TranslucencyFrame frame{.width = width, .height = height, .lights = lights};
    put(frame.position, in[0]);
    put(frame.normal, in[1]);
    put(frame.light, in[2]);
    put(frame.thickness, in[3]);  // the first third of it
    put(frame.lit, out);
    return frame;
  });
}

}  // namespace

TEST_CASE("textures and lights can be enqueued", "[many]") {
  const bool on_gpu = GENERATE(false, true);
  const std::string what = GENERATE("gaussians", "recursive", "shading", "translucency");
  const Device opened = Device::open();
  const Device device = on_gpu ? with_kernel_shape(opened, 1, "GPU") : opened;
  const Work work = what == "shading"        ? shading_work(device)
                    : what == "translucency" ? translucency_work(device)
                    : what == "gaussians"    ? texture_work(device, dermis::TextureMethod::gaussians)
                                             : texture_work(device, dermis::TextureMethod::recursive);
  const cl::Context context(device.context(), true);
  const cl::CommandQueue queue(context, cl::Device(device.id(), true), CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  Random random(7301);
  constexpr int frames = 4;
  std::vector<std::vector<float>> images;  // four of each frame
  std::vector<std::vector<float>> expected;
  std::vector<cl::Buffer> buffers, outputs;
  for (int i = 0; i < frames; ++i) {
    std::vector<const float*> in;
    for (int image = 0; image < 4; ++image) {
      std::vector<float> its(values);
      for (float& value : its) value = static_cast<float>(random.uniform(0.1, 1));
      buffers.emplace_back(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, values * sizeof(float), its.data());
      images.push_back(std::move(its));
      in.push_back(images.back().data());
    }
    work.run(in, expected.emplace_back(values).data());
    outputs.emplace_back(context, CL_MEM_READ_WRITE, values * sizeof(float));
  }
  CHECK(expected[0] != expected[1]);

  // Nothing begins before the gate opens, so nothing may wait for it.
  cl::UserEvent gate(context);
  const auto enqueue = [&](int i) {
    std::vector<cl_mem> in;
    for (int image = 0; image < 4; ++image) in.push_back(buffers[4 * i + image]());
    return work.enqueue(in, outputs[i](), queue(), gate());
  };
  std::vector<Event> events;
  events.push_back(enqueue(0));
  const MadeObjects before = made_objects();
  for (int i = 1; i < frames; ++i) events.push_back(enqueue(i));
  CHECK(made_objects() == before);
  gate.setStatus(CL_COMPLETE);
  for (int i = 0; i < frames; ++i) {
    CAPTURE(test_seed(), what, on_gpu, i);
    events[i].wait();
    std::vector<float> result(values);
    queue.enqueueReadBuffer(outputs[i], CL_TRUE, 0, values * sizeof(float), result.data());
    CHECK(result == expected[i]);
  }
}

TEST_CASE("what is enqueued lies in buffers", "[many]") {
  const Device device = Device::open();
  const cl::CommandQueue queue(cl::Context(device.context(), true), cl::Device(device.id(), true));
  std::vector<float> image(values);
  const dermis::TexturePlan plan(device, dermis::preset("skin").profile, {});
  const dermis::TextureFrame frame{.width = width,
                                   .height = height,
                                   .light = {.host = image.data()},
                                   .mm_per_texel = 1,
                                   .scattered = {.host = image.data()}};
  CHECK_THROWS_WITH(plan.enqueue(frame, queue()), "light: got host memory, want a buffer, to enqueue");
  CHECK_THROWS_WITH(plan.enqueue(frame, nullptr), "queue: got nullptr, want an OpenCL command queue");
}
