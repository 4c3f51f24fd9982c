#include "support/failing_calls.hpp"

#define CL_TARGET_OPENCL_VERSION 120
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl_icd.h>

#include <atomic>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace {

std::atomic<int> calls = 0;
std::atomic<int> failing = 0;
std::atomic<bool> fails_after = false;
std::atomic<const char*> failed = nullptr;
std::atomic<long> objects = 0;

bool fails(const char* name) {
  const int number = ++calls;
  const int at = failing;
  if (at == 0 || number < at || (number > at && !fails_after)) return false;
  const char* none = nullptr;
  failed.compare_exchange_strong(none, name);
  return true;
}

/// A function of the table, and the one in its place.
template <auto slot>
struct Call;

template <class Result, class... Arguments, Result (*cl_icd_dispatch::*slot)(Arguments...)>
struct Call<slot> {
  static inline Result (*real)(Arguments...) = nullptr;
  static inline const char* name = nullptr;

  static Result instead(Arguments... arguments) {
    constexpr cl_int error = CL_OUT_OF_HOST_MEMORY;
    const std::string_view kind = name;
    if (kind.starts_with("clRelease")) {
      if (!kind.ends_with("Device")) --objects;
      return real(arguments...);
    }
    [[maybe_unused]] const auto last = std::get<sizeof...(Arguments) - 1>(std::tie(arguments...));
    if (fails(name)) {
      if constexpr (std::is_same_v<Result, cl_int>) {
        return error;
      } else {
        if (last != nullptr) *last = error;
        return nullptr;
      }
    }
    const Result result = real(arguments...);
    if constexpr (std::is_same_v<Result, cl_int>) {
      const bool is_kept = kind.starts_with("clRetain") && !kind.ends_with("Device");
      bool makes_event = false;
      if constexpr (std::is_same_v<decltype(last), cl_event* const>) {
        makes_event = kind.starts_with("clEnqueue") && last != nullptr;
      }
      if (result == CL_SUCCESS && (is_kept || makes_event)) ++objects;
    } else if (result != nullptr && kind.starts_with("clCreate")) {
      ++objects;
    }
    return result;
  }
};

template <auto slot>
void replace(cl_icd_dispatch& table, const char* name) {
  Call<slot>::name = name;
  Call<slot>::real = table.*slot;
  table.*slot = &Call<slot>::instead;
}

}  // namespace

void install_failing_calls() {
  static bool is_installed = false;
  if (std::exchange(is_installed, true)) return;
  cl_platform_id platform = nullptr;
  if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS) throw std::runtime_error("no OpenCL platform");
  // What cl_khr_icd says of objects: the first that they hold is a pointer to the table.
  cl_icd_dispatch& table = **reinterpret_cast<cl_icd_dispatch**>(platform);
#define REPLACE(name) replace<&cl_icd_dispatch::name>(table, #name)
  REPLACE(clGetPlatformInfo);
  REPLACE(clGetDeviceIDs);
  REPLACE(clGetDeviceInfo);
  REPLACE(clCreateSubDevices);
  REPLACE(clRetainDevice);
  REPLACE(clReleaseDevice);
  REPLACE(clCreateContext);
  REPLACE(clRetainContext);
  REPLACE(clReleaseContext);
  REPLACE(clGetContextInfo);
  REPLACE(clCreateCommandQueue);
  REPLACE(clRetainCommandQueue);
  REPLACE(clReleaseCommandQueue);
  REPLACE(clGetCommandQueueInfo);
  REPLACE(clCreateBuffer);
  REPLACE(clRetainMemObject);
  REPLACE(clReleaseMemObject);
  REPLACE(clGetMemObjectInfo);
  REPLACE(clCreateProgramWithSource);
  REPLACE(clRetainProgram);
  REPLACE(clReleaseProgram);
  REPLACE(clBuildProgram);
  REPLACE(clGetProgramInfo);
  REPLACE(clGetProgramBuildInfo);
  REPLACE(clCreateKernel);
  REPLACE(clRetainKernel);
  REPLACE(clReleaseKernel);
  REPLACE(clSetKernelArg);
  REPLACE(clGetKernelInfo);
  REPLACE(clGetKernelWorkGroupInfo);
  REPLACE(clWaitForEvents);
  REPLACE(clGetEventInfo);
  REPLACE(clRetainEvent);
  REPLACE(clReleaseEvent);
  REPLACE(clSetEventCallback);
  REPLACE(clGetEventProfilingInfo);
  REPLACE(clFlush);
  REPLACE(clFinish);
  REPLACE(clEnqueueReadBuffer);
  REPLACE(clEnqueueWriteBuffer);
  REPLACE(clEnqueueFillBuffer);
  REPLACE(clEnqueueCopyBuffer);
  REPLACE(clEnqueueMapBuffer);
  REPLACE(clEnqueueUnmapMemObject);
  REPLACE(clEnqueueNDRangeKernel);
  REPLACE(clEnqueueMarkerWithWaitList);
#undef REPLACE
}

void fail_call(int number, bool all_after) {
  fails_after = all_after;
  failing = number;
  failed = nullptr;
  calls = 0;
}

int calls_made() { return calls; }

std::string failed_call() {
  const char* const name = failed;
  return name == nullptr ? "" : name;
}

long objects_held() { return objects; }
