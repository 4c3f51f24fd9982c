#include "opencl/device.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

#include "opencl/device_shape.hpp"

namespace dermis {

namespace {

DeviceInfo describe(const cl::Device& device) {
  DeviceInfo info;
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.platform = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
  info.driver = device.getInfo<CL_DRIVER_VERSION>();
  const DeviceShape shape = device_shape(device);
  info.type = shape.type;
  info.vector_width = shape.vector_width;
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  return info;
}

std::vector<cl::Device> all_devices() {
  std::vector<cl::Device> all;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return all;  // a loader without any driver reports an error instead of an empty list
  }
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue;
    }
    all.insert(all.end(), devices.begin(), devices.end());
  }
  return all;
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool matches(const cl::Device& device, std::size_t number, const std::string& name) {
  if (name == std::to_string(number)) return true;
  const bool is_number = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (is_number) return false;
  const DeviceInfo info = describe(device);
  return lower(info.type) == lower(name) || lower(info.name).find(lower(name)) != std::string::npos ||
         lower(info.platform).find(lower(name)) != std::string::npos;
}

cl::Device find_device(const std::string& name) {
  const std::vector<cl::Device> devices = all_devices();
  if (devices.empty()) {
    throw Error(ErrorCode::device, "device", "no OpenCL device", "an OpenCL driver, for instance pocl-opencl-icd");
  }
  if (name.empty()) {
    std::vector<DeviceInfo> infos;
    infos.reserve(devices.size());
    for (const cl::Device& device : devices) infos.push_back(describe(device));
    return devices[preferred_device(infos)];
  }
  std::string names;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (matches(devices[i], i, name)) return devices[i];
    names += (i == 0 ? "" : "; ") + std::to_string(i) + ": " + describe(devices[i]).name;
  }
  throw Error(ErrorCode::device, "device", "\"" + name + "\"", "one of " + names);
}

/// A part of a device with so many compute units, made once and kept until the process ends. In PoCL 3.1 neither
/// contexts nor queues retain their part, and one of its threads looks at the part after it has said that a command has
/// ended.
cl::Device part_of(const cl::Device& whole, int threads) {
  static std::mutex mutex;
  static std::map<std::pair<cl_device_id, int>, cl_device_id> parts;
  const std::scoped_lock lock(mutex);
  cl_device_id& part = parts[{whole(), threads}];
  if (part == nullptr) {
    const cl_device_partition_property properties[] = {CL_DEVICE_PARTITION_BY_COUNTS, threads,
                                                       CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> made;
    cl::Device(whole).createSubDevices(properties, &made);
    part = std::exchange(made.front()(), nullptr);  // for good
  }
  return cl::Device(part, true);
}

cl::Device with_threads(const cl::Device& device, int threads) {
  const auto available = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  if (threads < 1 || threads > available) {
    throw Error(ErrorCode::usage, "threads", std::to_string(threads), "1.." + std::to_string(available));
  }
  return threads == available ? device : part_of(device, threads);
}

}  // namespace

std::vector<DeviceInfo> Device::list() {
  return with_device_errors([] {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
  });
}

Device Device::open(std::string_view name, int threads) {
  return with_device_errors([&] {
    std::string wanted(name);
    if (const char* from_environment = std::getenv("DERMIS_DEVICE"); wanted.empty() && from_environment != nullptr) {
      wanted = from_environment;
    }
    cl::Device device = find_device(wanted);
    if (threads != 0) device = with_threads(device, threads);
    Device result;
    result.state_ = std::make_shared<State>(
        State{device, cl::Context(device), describe(device), device_shape(device).shares_host_memory});
    return result;
  });
}

Device Device::adopt(cl_context context, cl_device_id device) {
  if (context == nullptr || device == nullptr) {
    throw Error(ErrorCode::usage, context == nullptr ? "context" : "device", "nullptr", "an OpenCL handle");
  }
  return with_device_errors([&] {
    const cl::Device adopted(device, true);
    const cl::Context its_context(context, true);
    const std::vector<cl::Device> devices = its_context.getInfo<CL_CONTEXT_DEVICES>();
    if (std::none_of(devices.begin(), devices.end(), [&](const cl::Device& d) { return d() == device; })) {
      throw Error(ErrorCode::usage, "device", "a device of another context", "a device of the context");
    }
    Device result;
    result.state_ = std::make_shared<State>(
        State{adopted, its_context, describe(adopted), device_shape(adopted).shares_host_memory});
    return result;
  });
}

Device with_kernel_shape(const Device& device, int vector_width, std::string_view type) {
  Device::State state = *device.state_;
  state.info.vector_width = vector_width;
  state.info.type = type;
  state.shares_host_memory = type != "GPU";
  Device result;
  result.state_ = std::make_shared<Device::State>(state);
  return result;
}

Device with_largest_buffer(const Device& device, std::uint64_t bytes) {
  Device::State state = *device.state_;
  state.info.max_buffer_bytes = bytes;
  Device result;
  result.state_ = std::make_shared<Device::State>(state);
  return result;
}

bool shares_host_memory(const Device& device) { return device.state_->shares_host_memory; }

std::size_t preferred_device(std::span<const DeviceInfo> devices) {
  const auto gpu =
      std::find_if(devices.begin(), devices.end(), [](const DeviceInfo& its) { return its.type == "GPU"; });
  return gpu == devices.end() ? 0 : static_cast<std::size_t>(gpu - devices.begin());
}

DeviceCache& cache_of(const Device& device) { return *device.state_->cache; }

const DeviceInfo& Device::info() const { return state_->info; }

cl_context Device::context() const { return state_->context(); }

cl_device_id Device::id() const { return state_->device(); }

}  // namespace dermis
