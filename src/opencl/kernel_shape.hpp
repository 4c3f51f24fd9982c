// How the kernels for a device are built.
#pragma once

#include <string>

#include "opencl/opencl.hpp"

namespace dermis {

struct KernelShape {
  std::string type;  ///< DeviceInfo::type: on a "GPU" a work-item has one pixel
  int vector_width;  ///< DeviceInfo::vector_width
};

/// The shape that suits a device. It is in a file of its own, so that a test program can have another one in its place.
KernelShape kernel_shape(const cl::Device& device);

}  // namespace dermis
