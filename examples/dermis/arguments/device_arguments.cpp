#include "arguments/device_arguments.hpp"

#include <cstdint>
#include <limits>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"
#include "files/pocl_cache.hpp"
#include "report/messages.hpp"

namespace dermis::program {

std::vector<DeviceInfo> devices_there_are() {
  if (const auto warning = cache_warning()) print_warning(*warning);
  std::vector<DeviceInfo> devices = Device::list();
  if (!devices.empty()) return devices;
  const auto problem = cache_problem();
  throw Error(ErrorCode::device, "devices", problem ? "none: " + *problem : "none",
              problem ? "an OpenCL device, as PoCL is with POCL_CACHE_DIR=FOLDER that can be written"
                      : "an OpenCL device (is a driver installed, for instance PoCL?)");
}

Device open_device(const DeviceArguments& arguments) {
  devices_there_are();
  return Device::open(arguments.name, arguments.threads);
}

void add_device_argument(CLI::App& app, std::string& name) {
  app.add_option("--device", name,
                 "number, kind (CPU, GPU) or part of the name of a device, see `dermis devices`; else DERMIS_DEVICE, "
                 "else the first")
      ->type_name("NAME");
}

void add_device_arguments(CLI::App& app, DeviceArguments& arguments) {
  add_device_argument(app, arguments.name);
  app.add_option("--threads", arguments.threads, "use only that many compute units of a CPU")
      ->check(whole_number([](std::int64_t n) { return n >= 1 && n <= std::numeric_limits<int>::max(); },
                           "a whole number > 0"))
      ->type_name("N");
}

}  // namespace dermis::program
