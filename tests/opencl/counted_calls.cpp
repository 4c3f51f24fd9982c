#include "opencl/counted_calls.hpp"

#include <dlfcn.h>

#include <atomic>

#include "opencl/opencl.hpp"

namespace {

std::atomic<int> buffers = 0;
std::atomic<int> queues = 0;

template <class Function>
Function* next(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

MadeObjects made_objects() { return {buffers, queues}; }

extern "C" {

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* error) {
  ++buffers;
  return next("clCreateBuffer", &clCreateBuffer)(context, flags, size, host, error);
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties properties,
                                      cl_int* error) {
  ++queues;
  return next("clCreateCommandQueue", &clCreateCommandQueue)(context, device, properties, error);
}

}  // extern "C"
