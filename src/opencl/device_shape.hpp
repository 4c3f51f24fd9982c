// How dermis works on a device.
#pragma once

#include <string>

#include "opencl/opencl.hpp"

namespace dermis {

struct DeviceShape {
  std::string type;         ///< DeviceInfo::type: on a "GPU" a work-item has one pixel
  int vector_width;         ///< DeviceInfo::vector_width
  bool shares_host_memory;  ///< kernels read images of the host where they lie, else copies on the device
};

/// The shape that suits a device. It is in a file of its own, so that a test program can have another one in its place.
DeviceShape device_shape(const cl::Device& device);

}  // namespace dermis
