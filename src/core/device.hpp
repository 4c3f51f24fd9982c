// What the rest of the library needs of a Device.
#pragma once

#include "core/opencl.hpp"
#include "dermis/device.hpp"

namespace dermis {

struct Device::State {
  cl::Device device;
  cl::Context context;
  DeviceInfo info;
};

}  // namespace dermis
