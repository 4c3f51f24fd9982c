#include "arguments/device_arguments.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <limits>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"
#include "exr/memory_limit.hpp"
#include "files/pocl_cache.hpp"
#include "report/messages.hpp"

namespace dermis::program {

std::vector<DeviceInfo> devices_there_are() {
  // Measured with PoCL 3.1 on two cores: below 1050 MB its threads, or those of its compiler, may fail to start.
  exr::require_addresses("OpenCL", std::uint64_t{1200} << 20, std::uint64_t{24} << 20);
  if (const auto warning = fill_cache()) print_warning(*warning);
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

std::vector<std::string> device_notes(bool is_named, const DeviceInfo& taken, std::size_t there_are, bool reuses) {
  std::vector<std::string> notes;
  if (!is_named && there_are > 1)
    notes.push_back(fmt::format("device: {}, the first {} of {} devices (--device)", taken.name,
                                taken.type == "GPU" ? "GPU" : "one", there_are));
  if (reuses && taken.type == "GPU")
    notes.push_back(fmt::format("--reuse: does nothing on {}, for a GPU filters all of every frame", taken.name));
  return notes;
}

bool is_device_named(const DeviceArguments& arguments) {
  const char* from_environment = std::getenv("DERMIS_DEVICE");
  return !arguments.name.empty() || (from_environment != nullptr && *from_environment != '\0');
}

void add_device_argument(CLI::App& app, std::string& name) {
  app.add_option("--device", name,
                 "number, kind (CPU, GPU) or part of the name of a device, see `dermis devices`; else DERMIS_DEVICE, "
                 "else the first GPU, else the first")
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
