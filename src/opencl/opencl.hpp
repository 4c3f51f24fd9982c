// The OpenCL C++ bindings, version 1.2, with errors as ours, arguments of kernels, uploads and times.
//
// Where a retain fails, the bindings' copy constructor throws and leaves nothing behind, but their copy assignment
// throws with a handle that it does not own and will release. So handles are copied by construction, then moved.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <chrono>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/error.hpp"

namespace dermis {

/// Runs `work`; an OpenCL error becomes Error(device) with the name of the call.
template <class Work>
auto with_device_errors(Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const cl::Error& error) {
    throw Error(ErrorCode::device, error.what(), "OpenCL error " + std::to_string(error.err()), "success");
  }
}

/// Waits until the device is done with the commands of a queue, so that their memory may go. False if the driver does
/// not say so within seconds, as when it has lost the device.
inline bool wait_until_idle(const cl::CommandQueue& queue) noexcept {
  constexpr std::chrono::milliseconds longest{1024};
  for (std::chrono::milliseconds pause{1}; clFinish(queue()) != CL_SUCCESS; pause *= 2) {
    if (pause > longest) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

template <class Argument>
void set_argument(cl::Kernel& kernel, cl_uint& index, const Argument& argument) {
  kernel.setArg(index++, argument);
}

inline void set_argument(cl::Kernel& kernel, cl_uint& index, const std::vector<cl::Buffer>& buffers) {
  for (const cl::Buffer& buffer : buffers) kernel.setArg(index++, buffer);
}

/// Sets all arguments of a kernel, in their order. A vector of buffers is as many arguments.
template <class... Arguments>
void set_arguments(cl::Kernel& kernel, const Arguments&... arguments) {
  cl_uint index = 0;
  (set_argument(kernel, index, arguments), ...);
}

/// Makes a buffer of rows that kernels only read; there is at least one row.
template <class Row>
cl::Buffer upload(const cl::Context& context, std::span<const Row> rows) {
  return {context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, rows.size_bytes(), const_cast<Row*>(rows.data())};
}

template <class Row>
cl::Buffer upload(const cl::Context& context, const std::vector<Row>& rows) {
  return upload(context, std::span<const Row>(rows));
}

/// The time that the device worked on commands of a queue with CL_QUEUE_PROFILING_ENABLE, ms.
inline double milliseconds(const std::vector<cl::Event>& events) {
  double sum = 0;
  for (const cl::Event& event : events) {
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    sum += static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
  }
  return sum;
}

}  // namespace dermis
