// What the rest of the library needs of a Device.
#pragma once

#include "dermis/device.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

struct Device::State {
  cl::Device device;
  cl::Context context;
  DeviceInfo info;
  std::shared_ptr<DeviceCache> cache = std::make_shared<DeviceCache>();
};

/// The same device, whose kernels are built as for one of another vector width (1, 4, 8 or 16) and type. So that the
/// code that a GPU gets can be tested on a CPU.
Device with_kernel_shape(const Device& device, int vector_width, std::string_view type);

}  // namespace dermis
