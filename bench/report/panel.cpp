#include "report/panel.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/gnuplot.hpp"

namespace dermis::bench {

namespace {

using program::script_string;

bool has_points(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(),
                     [](const Curve& curve) { return !curve.points.empty(); });
}

std::string script_of(const Panel& panel, int number) {
  std::string data, plots;
  const auto add = [&plots](const std::string& plot) { plots += (plots.empty() ? "plot " : ", ") + plot; };
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    if (curve.points.empty()) continue;
    const std::string name = fmt::format("$panel{}curve{}", number, i);
    data += name + " << EOD\n";
    for (const auto& [x, y, label] : curve.points) data += fmt::format("{:.6g} {:.6g} \"{}\"\n", x, y, label);
    data += "EOD\n";
    add(fmt::format("{} using 1:2 {} with {}", name,
                    curve.title.empty() ? "notitle" : "title " + script_string(curve.title), curve.style));
    if (!curve.label_style.empty()) add(fmt::format("{} using 1:2:3 with labels {} notitle", name, curve.label_style));
  }
  return fmt::format(
      "reset\nunset mxtics\nunset mytics\nset grid lc rgb '#dddddd' lw 0.6\nset border lc rgb '#444444'\n"
      "set key noautotitle samplen 1.8 Left reverse\n{}set title {} noenhanced\n{}\n{}\n",
      data, script_string(panel.title), panel.settings, plots);
}

}  // namespace

void draw(std::string_view option, const std::filesystem::path& path, std::vector<Panel> panels, int columns,
          const PanelSize& size) {
  std::erase_if(panels, [](const Panel& panel) { return !has_points(panel); });
  if (panels.empty()) return;
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  std::string script = fmt::format("set multiplot layout {},{}\n", rows, columns);
  for (std::size_t i = 0; i < panels.size(); ++i) script += script_of(panels[i], static_cast<int>(i));
  program::draw_figure(option, path, {columns * size.width_px, rows * size.height_px, "dynamic font 'Helvetica,14'"},
                       script + "unset multiplot\n");
}

}  // namespace dermis::bench
