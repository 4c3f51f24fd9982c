/// The OpenCL device that does the work.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct _cl_context;
struct _cl_device_id;
using cl_context = struct _cl_context*;
using cl_device_id = struct _cl_device_id*;

namespace dermis {

/// The properties that an OpenCL device reports.
struct DeviceInfo {
  std::string name;
  std::string platform;
  std::string driver;
  std::string type;  ///< "CPU", "GPU", "accelerator" or "other"
  int compute_units = 0;
  int vector_width = 1;  ///< the kernels are built for so many float lanes: 1, 4, 8 or 16
  std::uint64_t memory_bytes = 0;
  std::uint64_t max_buffer_bytes = 0;
};

/// A device and a context on it. Cheap to copy; copies share the context.
class Device {
 public:
  /// All devices of all platforms, in the order that `open` numbers them; empty if there is none.
  static std::vector<DeviceInfo> list();

  /// Opens a device: `name` is a number from `list`, a type ("CPU") or a part of a name or platform, in any case; if
  /// empty, the environment variable DERMIS_DEVICE says the same; if that is empty too, the first GPU, or the first
  /// device if there is none. `threads` > 0 uses only that many compute units of a CPU device. Throws Error(device) if
  /// there is no such device, Error(usage) if `threads` is out of range.
  static Device open(std::string_view name = {}, int threads = 0);

  /// Uses the caller's context and device. Retains both.
  static Device adopt(cl_context context, cl_device_id device);

  const DeviceInfo& info() const;
  cl_context context() const;
  cl_device_id id() const;

 private:
  struct State;
  friend struct DeviceCache& cache_of(const Device& device);
  friend Device with_kernel_shape(const Device& device, int vector_width, std::string_view type);
  friend Device with_largest_buffer(const Device& device, std::uint64_t bytes);
  friend bool shares_host_memory(const Device& device);
  Device() = default;
  std::shared_ptr<const State> state_;
};

}  // namespace dermis
