// dermis devices: what --device can name.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "commands/commands.hpp"
#include "commands/device_test.hpp"
#include "dermis/device.hpp"
#include "dermis/error.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

void list(const std::vector<DeviceInfo>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    print(fmt::format("{}  {}, {}: {}, {} compute units, {} floats wide, {:.1f} GiB, driver {}\n", i, device.name,
                      device.platform, device.type, device.compute_units, device.vector_width,
                      static_cast<double>(device.memory_bytes) / (1 << 30), device.driver));
  }
}

/// Returns the exit code.
int test(const std::vector<DeviceInfo>& devices) {
  bool all_passed = true;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceTest its = test_device(std::to_string(i));
    print(fmt::format("{}  {}, {}: {}\n", i, devices[i].name, devices[i].platform, its.text));
    all_passed = all_passed && its.passed;
  }
  return all_passed ? 0 : static_cast<int>(ErrorCode::device);
}

int run_devices(bool tests) {
  const std::vector<DeviceInfo> devices = devices_there_are();
  if (tests) return test(devices);
  list(devices);
  return 0;
}

}  // namespace

Command add_devices(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("devices", "list the OpenCL devices, with the number that --device takes");
  const auto tests = std::make_shared<bool>(false);
  app->add_flag("--test", *tests,
                "filter a small frame on each instead, and compare it with the same in double precision; fails if a "
                "device refuses or is wrong");
  return {app, [tests] { return run_devices(*tests); }};
}

}  // namespace dermis::program
