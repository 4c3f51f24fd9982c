/// The device to work on: --device and --threads.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
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

/// What there is to say of the device that was taken: that it was chosen, if it was not named and there are others, and
/// that it cannot do what `--reuse` asks.
std::vector<std::string> device_notes(bool is_named, const DeviceInfo& taken, std::size_t there_are, bool reuses);

/// Whether --device or the environment names one.
bool is_device_named(const DeviceArguments& arguments);

/// Throws as devices_there_are and Device::open.
Device open_device(const DeviceArguments& arguments);

}  // namespace dermis::program
