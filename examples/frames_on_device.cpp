// Ten frames that never leave the device: a spot moves over a wall, Shading makes the light of each frame and a Plan
// scatters it. The host hands over all frames at once, and then reads times from events and one pixel of each frame.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <cstdio>
#include <dermis/dermis.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace {

constexpr int width = 640, height = 360, frames = 10;
constexpr double focal_px = 1600, distance_mm = 100;

void check(cl_int status, const char* call) {
  if (status != CL_SUCCESS)
    throw std::runtime_error(std::string(call) + " gave OpenCL error " + std::to_string(status));
}

struct ReleaseBuffer {
  void operator()(cl_mem buffer) const { clReleaseMemObject(buffer); }
};
using Buffer = std::unique_ptr<std::remove_pointer_t<cl_mem>, ReleaseBuffer>;

struct ReleaseQueue {
  void operator()(cl_command_queue queue) const { clReleaseCommandQueue(queue); }
};
using Queue = std::unique_ptr<std::remove_pointer_t<cl_command_queue>, ReleaseQueue>;

/// A buffer of floats, with those if there are any.
Buffer make_buffer(cl_context context, std::size_t count, const float* floats = nullptr) {
  cl_int status = CL_SUCCESS;
  const cl_mem_flags copies = floats != nullptr ? CL_MEM_COPY_HOST_PTR : 0;
  Buffer buffer(
      clCreateBuffer(context, CL_MEM_READ_WRITE | copies, count * sizeof(float), const_cast<float*>(floats), &status));
  check(status, "clCreateBuffer");
  return buffer;
}

/// When the command of an event ended, ms.
double end_ms(const dermis::Event& event) {
  cl_ulong time_ns = 0;
  check(clGetEventProfilingInfo(event.handle(), CL_PROFILING_COMMAND_END, sizeof time_ns, &time_ns, nullptr),
        "clGetEventProfilingInfo");
  return static_cast<double>(time_ns) * 1e-6;
}

/// A wall of skin, in the axes of the camera: what does not change from frame to frame.
struct Wall {
  Buffer position, normal, albedo, depth;

  explicit Wall(cl_context context) {
    std::vector<float> points, normals, white, depths;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double scale = distance_mm / focal_px;
        points.insert(points.end(),
                      {static_cast<float>((x + 0.5 - width / 2.0) * scale),
                       static_cast<float>((y + 0.5 - height / 2.0) * scale), static_cast<float>(distance_mm)});
        normals.insert(normals.end(), {0, 0, -1});
        white.insert(white.end(), {0.8F, 0.6F, 0.5F});
        depths.push_back(static_cast<float>(distance_mm));
      }
    }
    position = make_buffer(context, points.size(), points.data());
    normal = make_buffer(context, normals.size(), normals.data());
    albedo = make_buffer(context, white.size(), white.data());
    depth = make_buffer(context, depths.size(), depths.data());
  }
};

void run() {
  const dermis::Device device = dermis::Device::open();
  cl_int status = CL_SUCCESS;
  const Queue queue(clCreateCommandQueue(device.context(), device.id(), CL_QUEUE_PROFILING_ENABLE, &status));
  check(status, "clCreateCommandQueue");
  const std::size_t values = std::size_t{3} * width * height;
  const Wall wall(device.context());
  const Buffer light = make_buffer(device.context(), values);
  std::vector<Buffer> scattered;

  const dermis::Shading shading(device, {.lobes = {}});
  const dermis::Plan plan(device, {{.profile = dermis::preset("skin").profile}}, {.depth = true});
  std::vector<dermis::Event> lit, done;
  for (int i = 0; i < frames; ++i) {
    scattered.push_back(make_buffer(device.context(), values));
    const std::vector<dermis::Light> spot{{.kind = dermis::Light::Kind::spot,
                                           .direction = {0, 0, 1},
                                           .position = {2.0 * i - 9, 0, distance_mm - 20},
                                           .colour = {1, 1, 1},
                                           .attenuation = {1, 0, 0},
                                           .cone_inner_deg = 10,
                                           .cone_outer_deg = 10.5}};
    const dermis::ShadingFrame surface = {.width = width,
                                          .height = height,
                                          .position = {.buffer = wall.position.get()},
                                          .normal = {.buffer = wall.normal.get()},
                                          .albedo = {.buffer = wall.albedo.get()},
                                          .lights = spot,
                                          .light = {.buffer = light.get()}};
    const dermis::Frame frame = {.width = width,
                                 .height = height,
                                 .light = {.buffer = light.get()},
                                 .depth = {.buffer = wall.depth.get()},
                                 .camera = dermis::Camera::perspective(focal_px, focal_px, width / 2.0, height / 2.0),
                                 .scattered = {.buffer = scattered.back().get()}};
    // The next frame's light waits until this one has been scattered: each begins where the last one ends.
    std::vector<cl_event> after;
    if (!done.empty()) after.push_back(done.back().handle());
    lit.push_back(shading.enqueue(surface, queue.get(), after));
    const cl_event light_is_there = lit.back().handle();
    done.push_back(plan.enqueue(frame, queue.get(), {&light_is_there, 1}));
  }

  for (int i = 0; i < frames; ++i) {
    float rgb[3];
    const cl_event after = done[i].handle();
    check(clEnqueueReadBuffer(queue.get(), scattered[i].get(), CL_TRUE,
                              3 * sizeof(float) * (width * (height / 2) + width / 2), sizeof rgb, rgb, 1, &after,
                              nullptr),
          "clEnqueueReadBuffer");
    std::printf("frame %d: %.3f %.3f %.3f", i + 1, static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                static_cast<double>(rgb[2]));
    if (i > 0)
      std::printf(", lit in %.2f ms, scattered in %.2f ms", end_ms(lit[i]) - end_ms(done[i - 1]),
                  end_ms(done[i]) - end_ms(lit[i]));
    std::printf("\n");
  }
}

}  // namespace

int main() try { run(); } catch (const dermis::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(error.code());
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 7;
}
