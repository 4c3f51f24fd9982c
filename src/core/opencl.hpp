// The OpenCL C++ bindings, version 1.2, and how their errors become ours.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <string>
#include <utility>

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

}  // namespace dermis
