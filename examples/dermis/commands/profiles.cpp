// dermis profiles: the presets, as a table and as curves.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "arguments/word_argument.hpp"
#include "commands/commands.hpp"
#include "dermis/profile.hpp"
#include "files/output_file.hpp"
#include "report/profile_plot.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

void print_table() {
  print(fmt::format("{:<16}{:>30}  {}\n", "name", "99.9 % within, mm (R G B)", "source"));
  for (const Preset& preset : presets()) {
    const auto radius = [&](int channel) { return preset.profile.radius(channel, 0.999); };
    print(fmt::format("{:<16}{:>10.3g}{:>10.3g}{:>10.3g}  {}\n", preset.name, radius(0), radius(1), radius(2),
                      preset.source));
  }
}

int run_profiles(const std::string& plot) {
  if (!plot.empty()) {
    check_writable("--plot", plot);
    plot_profiles("--plot", plot, presets());
  }
  print_table();
  return 0;
}

}  // namespace

Command add_profiles(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("profiles", "list the presets: name, reach and source");
  const auto plot = std::make_shared<std::string>();
  app->add_option("--plot", *plot, "also draw R(r) 2 pi r, the light that leaves per mm of distance; needs gnuplot")
      ->check(file_name_ending({".svg", ".png"}))
      ->type_name("FILE.svg|png");
  return {app, [plot] { return run_profiles(*plot); }};
}

}  // namespace dermis::program
