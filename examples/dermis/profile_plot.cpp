#include "profile_plot.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "dermis/error.hpp"
#include "output_file.hpp"

namespace dermis::program {
namespace {

constexpr int columns = 3;
constexpr int points = 200;
constexpr const char* colours[] = {"#c02020", "#209020", "#2040c0"};

/// A string of a gnuplot script.
std::string script_string(std::string_view text) {
  std::string result(1, '\'');
  for (const char c : text) {
    if (c == '\'') result.push_back(c);
    result.push_back(c);
  }
  result.push_back('\'');
  return result;
}

std::string header(const std::filesystem::path& output, bool svg, int rows) {
  const int width = 360 * columns;
  const int height = 260 * rows;
  return fmt::format("set terminal {} size {},{}\nset output {}\nset multiplot layout {},{}\n",
                     svg ? "svg background 'white'" : "pngcairo", width, height, script_string(output.string()), rows,
                     columns);
}

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
  for (int c = 0; c < 3; ++c)
    text += fmt::format("{}$c{} with lines linewidth 2 linecolor rgb '{}'", c == 0 ? "" : ", ", c, colours[c]);
  return text + "\n";
}

void run_gnuplot(std::string_view argument, const std::string& script) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    throw Error(ErrorCode::output, argument, "no gnuplot", "gnuplot on the PATH");
  const auto before = std::signal(SIGPIPE, SIG_IGN);  // if gnuplot ends early, its exit status tells
  std::FILE* pipe = popen("gnuplot", "w");
  if (pipe != nullptr) std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = pipe != nullptr ? pclose(pipe) : -1;
  std::signal(SIGPIPE, before);
  if (status != 0)
    throw Error(ErrorCode::output, argument, fmt::format("exit status {} from gnuplot", status), "a plot");
}

}  // namespace

void plot_profiles(std::string_view argument, const std::filesystem::path& path, std::span<const Preset> presets) {
  if (path.string().find('\n') != std::string::npos)
    throw Error(ErrorCode::usage, argument, path.string(), "a file name without line ends");
  TemporaryFile temporary(argument, path);
  const int rows = (static_cast<int>(presets.size()) + columns - 1) / columns;
  std::string script = header(temporary.path(), path.extension() != ".png" && path.extension() != ".PNG", rows);
  for (const Preset& preset : presets) script += panel(preset);
  run_gnuplot(argument, script + "unset multiplot\nunset output\n");
  temporary.commit();
}

}  // namespace dermis::program
