#include "opencl/device_buffer.hpp"

#include <cstdio>
#include <string>

namespace dermis {

namespace {

cl::Buffer make(const Device& device, std::string_view name, std::size_t bytes, void* host, cl_mem_flags flags) {
  check_buffer_size(device, name, bytes);
  try {
    return {cl::Context(device.context(), true), flags, bytes, host};
  } catch (const cl::Error& error) {
    throw Error(ErrorCode::device, std::string(name) + " buffer",
                megabytes(bytes) + " and OpenCL error " + std::to_string(error.err()),
                "room for it on " + device.info().name);
  }
}

}  // namespace

std::string megabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) * 1e-6);
  return text;
}

void check_buffer_size(const Device& device, std::string_view name, std::size_t bytes) {
  const DeviceInfo& info = device.info();
  if (bytes <= info.max_buffer_bytes) return;
  throw Error(ErrorCode::device, std::string(name) + " buffer", megabytes(bytes),
              "at most " + megabytes(info.max_buffer_bytes) + ", the largest buffer of " + info.name);
}

cl::Buffer device_buffer(const Device& device, std::string_view name, std::size_t bytes) {
  return make(device, name, bytes, nullptr, CL_MEM_READ_WRITE);
}

cl::Buffer buffer_over(const Device& device, std::string_view name, std::size_t bytes, void* host,
                       cl_mem_flags access) {
  return make(device, name, bytes, host, access | CL_MEM_USE_HOST_PTR);
}

}  // namespace dermis
