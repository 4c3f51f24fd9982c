/// The device to work on: --device and --threads.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "dermis/device.hpp"

namespace dermis::program {

struct DeviceArguments {
  std::string name;
  int threads = 0;  ///< 0: all of them
};

void add_device_argument(CLI::App& app, std::string& name);
void add_device_arguments(CLI::App& app, DeviceArguments& arguments);

inline Device open_device(const DeviceArguments& arguments) { return Device::open(arguments.name, arguments.threads); }

}  // namespace dermis::program
