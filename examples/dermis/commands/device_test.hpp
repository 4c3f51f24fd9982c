/// Whether a device computes what it should.
#pragma once

#include <string>

#include "dermis/device.hpp"

namespace dermis::program {

struct DeviceTest {
  bool passed = false;
  std::string text;  ///< one line: how far it is off, or what it refused
};

/// Filters a small frame by each method of which the oracle tells how far float32 may be off.
DeviceTest test_device(const std::string& name);

}  // namespace dermis::program
