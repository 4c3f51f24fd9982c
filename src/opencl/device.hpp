// The state of a Device, for the rest of the library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "dermis/device.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

struct Device::State {
  cl::Device device;
  cl::Context context;
  DeviceInfo info;
  bool shares_host_memory;
  std::shared_ptr<DeviceCache> cache = std::make_shared<DeviceCache>();
};

/// Returns the device with another vector width (1, 4, 8 or 16) and type, for which its kernels are built: so the code
/// that a GPU gets can be tested on a CPU.
Device with_kernel_shape(const Device& device, int vector_width, std::string_view type);

/// Returns the device as if its buffers could be no larger.
Device with_largest_buffer(const Device& device, std::uint64_t bytes);

/// DeviceShape::shares_host_memory.
bool shares_host_memory(const Device& device);

/// The index of the device to take if none is named: of the first GPU, else 0.
std::size_t preferred_device(std::span<const DeviceInfo> devices);

/// Whether a work-item computes one pixel, as on GPUs; else runs of pixels.
inline bool item_is_pixel(const Device& device) { return device.info().type == "GPU"; }

}  // namespace dermis
