#include "arguments/device_arguments.hpp"

#include <cstdint>
#include <limits>

#include "arguments/number_argument.hpp"

namespace dermis::program {

void add_device_argument(CLI::App& app, std::string& name) {
  app.add_option("--device", name,
                 "number or part of the name of a device, see `dermis devices`; else DERMIS_DEVICE, else the first")
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
