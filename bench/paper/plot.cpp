#include "paper/plot.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "dermis/error.hpp"

namespace dermis::bench {

namespace {

constexpr int panel_width_px = 420;
constexpr int panel_height_px = 380;

/// A string of a gnuplot script.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

std::string script_of(const Panel& panel, int number) {
  std::string data;
  std::string plots;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const std::string name = fmt::format("$panel{}curve{}", number, i);
    data += name + " << EOD\n";
    for (const auto& [x, y] : curve.points) data += fmt::format("{:.6g} {:.6g}\n", x, y);
    data += "EOD\n";
    plots += fmt::format("{}{} using 1:2 {} with {}", i == 0 ? "plot " : ", ", name,
                         curve.title.empty() ? "notitle" : "title " + quoted(curve.title), curve.style);
  }
  return data + "set title " + quoted(panel.title) + "\n" + panel.settings + "\n" + plots + "\n";
}

}  // namespace

void need_gnuplot() {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    throw Error(ErrorCode::output, "--paper", "no gnuplot", "gnuplot on the PATH");
  }
}

void draw(const std::filesystem::path& path, const std::vector<Panel>& panels, int columns) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  std::string script = fmt::format(
      "set terminal svg size {},{} dynamic background 'white' font 'Helvetica,14'\nset output {}\n"
      "set multiplot layout {},{}\n",
      columns * panel_width_px, rows * panel_height_px, quoted(path.string()), rows, columns);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    script +=
        "reset\nunset mxtics\nunset mytics\nset grid lc rgb '#dddddd' lw 0.6\nset border lc rgb '#444444'\nset key "
        "noautotitle samplen 1.8 Left "
        "reverse\n" +
        script_of(panels[i], static_cast<int>(i));
  }
  script += "unset multiplot\nunset output\n";

  const auto before = std::signal(SIGPIPE, SIG_IGN);  // if gnuplot ends early, its exit status tells
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot != nullptr) std::fwrite(script.data(), 1, script.size(), gnuplot);
  const int status = gnuplot != nullptr ? pclose(gnuplot) : -1;
  std::signal(SIGPIPE, before);
  if (status != 0) throw Error(ErrorCode::output, "--paper", path.string(), "gnuplot to draw it");
}

}  // namespace dermis::bench
