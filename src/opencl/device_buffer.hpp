// Memory on a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "opencl/device.hpp"

namespace dermis {

/// A buffer for kernels to read and write. Throws Error(device) with the name of the buffer, the size asked and the
/// size allowed if it is larger than the device's buffers may be, or the device has no room.
cl::Buffer device_buffer(const Device& device, std::string_view name, std::size_t bytes);

/// The same over memory of the host.
cl::Buffer buffer_over(const Device& device, std::string_view name, std::size_t bytes, void* host, cl_mem_flags access);

/// A size as messages have it.
std::string megabytes(std::uint64_t bytes);

/// Throws as device_buffer if no buffer of the device is as large.
void check_buffer_size(const Device& device, std::string_view name, std::size_t bytes);

}  // namespace dermis
