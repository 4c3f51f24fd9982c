// A caller with OpenCL objects of its own: context, queue, buffers and wait list. Nothing here blocks before the last
// read.
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

void check(cl_int status, const char* call) {
  if (status != CL_SUCCESS)
    throw std::runtime_error(std::string(call) + " gave OpenCL error " + std::to_string(status));
}

template <typename Handle, auto release>
struct Release {
  void operator()(Handle handle) const { release(handle); }
};
template <typename Handle, auto release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release<Handle, release>>;

using Context = Owned<cl_context, clReleaseContext>;
using Queue = Owned<cl_command_queue, clReleaseCommandQueue>;
using Buffer = Owned<cl_mem, clReleaseMemObject>;
using OwnEvent = Owned<cl_event, clReleaseEvent>;

cl_device_id first_device() {
  cl_uint count = 0;
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) throw std::runtime_error("no OpenCL platform");
  std::vector<cl_platform_id> platforms(count);
  check(clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");
  for (cl_platform_id platform : platforms) {
    cl_device_id device = nullptr;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr) == CL_SUCCESS) return device;
  }
  throw std::runtime_error("no OpenCL device");
}

Buffer make_buffer(cl_context context, std::size_t bytes) {
  cl_int status = CL_SUCCESS;
  Buffer buffer(clCreateBuffer(context, CL_MEM_READ_WRITE, bytes, nullptr, &status));
  check(status, "clCreateBuffer");
  return buffer;
}

/// Starts filling a buffer with copies of one value.
OwnEvent fill(cl_command_queue queue, cl_mem buffer, float value, std::size_t first, std::size_t count) {
  cl_event filled = nullptr;
  check(clEnqueueFillBuffer(queue, buffer, &value, sizeof value, first * sizeof value, count * sizeof value, 0, nullptr,
                            &filled),
        "clEnqueueFillBuffer");
  return OwnEvent(filled);
}

void run() {
  cl_device_id device = first_device();
  cl_int status = CL_SUCCESS;
  const Context context(clCreateContext(nullptr, 1, &device, nullptr, nullptr, &status));
  check(status, "clCreateContext");
  const Queue queue(clCreateCommandQueue(context.get(), device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, &status));
  check(status, "clCreateCommandQueue");

  // A wall 100 mm away, lit above the middle, in shadow below it; 4 px to the millimetre.
  const int width = 160, height = 90;
  const std::size_t pixels = static_cast<std::size_t>(width) * height, lit = 3 * pixels / 2;
  const Buffer light = make_buffer(context.get(), 3 * pixels * sizeof(float));
  const Buffer depth = make_buffer(context.get(), pixels * sizeof(float));
  const Buffer scattered = make_buffer(context.get(), 3 * pixels * sizeof(float));
  const OwnEvent light_above = fill(queue.get(), light.get(), 1.0F, 0, lit);
  const OwnEvent light_below = fill(queue.get(), light.get(), 0.02F, lit, lit);
  const OwnEvent depth_filled = fill(queue.get(), depth.get(), 100.0F, 0, pixels);

  const dermis::Frame frame = {.width = width,
                               .height = height,
                               .light = {.buffer = light.get()},
                               .depth = {.buffer = depth.get()},
                               .camera = dermis::Camera::perspective(400, 400, width / 2.0, height / 2.0),
                               .mm_per_unit = 1,
                               .scattered = {.buffer = scattered.get()}};
  const dermis::Plan plan(dermis::Device::adopt(context.get(), device), {{.profile = dermis::preset("skin").profile}},
                          dermis::FrameDescription::of(frame));
  const std::vector<cl_event> inputs = {light_above.get(), light_below.get(), depth_filled.get()};
  const dermis::Event done = plan.enqueue(frame, queue.get(), inputs);

  // The pixels on both sides of the edge, in the middle column.
  for (const int y : {height / 2 - 1, height / 2}) {
    float rgb[3];
    const cl_event after = done.handle();
    check(clEnqueueReadBuffer(queue.get(), scattered.get(), CL_TRUE, 3 * sizeof(float) * (width * y + width / 2),
                              sizeof rgb, rgb, 1, &after, nullptr),
          "clEnqueueReadBuffer");
    std::printf("row %d: %.3f %.3f %.3f\n", y, rgb[0], rgb[1], rgb[2]);
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
