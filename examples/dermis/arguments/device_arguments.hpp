/// The device to work on: --device and --threads.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "dermis/device.hpp"

namespace dermis::program {

struct DeviceArguments {
  std::string name;
  int threads = 0;  ///< 0: all of them
};

void add_device_argument(CLI::App& app, std::string& name);
void add_device_arguments(CLI::App& app, DeviceArguments& arguments);

/// All devices. Throws Error(device) that says what is in the way if there is none.
std::vector<DeviceInfo> devices_there_are();

/// Throws as devices_there_are and Device::open.
Device open_device(const DeviceArguments& arguments);

}  // namespace dermis::program
