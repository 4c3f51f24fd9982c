// dermis devices: what --device can name.
#include <fmt/format.h>

#include <vector>

#include "arguments/device_arguments.hpp"
#include "commands/commands.hpp"
#include "dermis/device.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

int run_devices() {
  const std::vector<DeviceInfo> devices = devices_there_are();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    print(fmt::format("{}  {}, {}: {}, {} compute units, {} floats wide, {:.1f} GiB, driver {}\n", i, device.name,
                      device.platform, device.type, device.compute_units, device.vector_width,
                      static_cast<double>(device.memory_bytes) / (1 << 30), device.driver));
  }
  return 0;
}

}  // namespace

Command add_devices(CLI::App& parent) {
  return {parent.add_subcommand("devices", "list the OpenCL devices, with the number that --device takes"),
          run_devices};
}

}  // namespace dermis::program
