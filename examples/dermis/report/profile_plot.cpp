#include "report/profile_plot.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numbers>
#include <string>

#include "report/gnuplot.hpp"

namespace dermis::program {
namespace {

constexpr int profile_columns = 3;
constexpr int points = 200;

/// The points of one channel, as inline data. Narrow channels fall to nothing on the way.
std::string curve(const Profile& profile, int channel, double radius_mm) {
  std::string text = fmt::format("$c{} << EOD\n", channel);
  for (int i = 1; i <= points; ++i) {
    const double r = radius_mm * i / points;
    text += fmt::format("{:.6g} {:.6g}\n", r, profile.radial(channel, r) * 2 * std::numbers::pi * r);
  }
  return text + "EOD\n";
}

std::string panel(const Preset& preset) {
  const double radius_mm = preset.profile.radius(preset.profile.widest_channel(), 0.95);
  std::string text;
  for (int c = 0; c < 3; ++c) text += curve(preset.profile, c, radius_mm);
  text += fmt::format("set title {} noenhanced\nset xlabel 'r, mm'\nset ylabel 'R(r) 2 pi r, 1/mm'\nunset key\nplot ",
                      script_string(preset.name));
  for (std::size_t c = 0; c < 3; ++c)
    text += fmt::format("{}$c{} with lines linewidth 2 linecolor rgb '{}'", c == 0 ? "" : ", ", c, channel_colours[c]);
  return text + "\n";
}

}  // namespace

void plot_profiles(std::string_view argument, const std::filesystem::path& path, std::span<const Preset> presets) {
  const int rows = (static_cast<int>(presets.size()) + profile_columns - 1) / profile_columns;
  std::string script = fmt::format("set multiplot layout {},{}\n", rows, profile_columns);
  for (const Preset& preset : presets) script += panel(preset);
  draw_figure(argument, path, {360 * profile_columns, 260 * rows}, script + "unset multiplot\n");
}

}  // namespace dermis::program
