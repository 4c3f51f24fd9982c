#include "report/chart.hpp"

#include <fmt/format.h>

#include "report/gnuplot.hpp"

namespace dermis::bench {

namespace {

std::string data_block(const std::string& name, const Series& series) {
  std::string text = name + " << EOD\n";
  for (const ChartPoint& point : series.points) {
    text += fmt::format("{:.6g} {:.6g} \"{}\"\n", point.x, point.y, point.label);
  }
  return text + "EOD\n";
}

}  // namespace

std::string script_of(const Chart& chart) {
  std::string data;
  std::string plots;
  const auto add = [&plots](const std::string& plot) { plots += (plots.empty() ? "plot " : ", ") + plot; };
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const Series& series = chart.series[i];
    if (series.points.empty()) continue;
    const std::string name = fmt::format("$series{}", i);
    data += data_block(name, series);
    const std::string marks = series.style == "lines" ? "" : fmt::format(" pt {} ps 0.8", series.point_type);
    add(fmt::format("{} using 1:2 with {} lc rgb '{}' lw {} dt {}{} title {}", name, series.style, series.colour,
                    series.line_width, series.dash_type, marks, gnuplot_string(series.title)));
    add(fmt::format("{} using 1:2:3 with labels tc rgb '{}' font ',10' offset 0,{} notitle", name, series.colour,
                    series.labels_below ? -0.75 : 0.75));
  }
  return fmt::format(
             "reset\nset logscale xy\nunset mxtics\nunset mytics\nset grid lc rgb '#dddddd' lw 0.6\nset border 3 lc "
             "rgb "
             "'#444444'\nset tics nomirror\nset key outside right top noautotitle samplen 1.8 Left reverse font ',12'\n"
             "set title {} noenhanced\nset xlabel {}\nset ylabel {}\n{}\n",
             gnuplot_string(chart.title), gnuplot_string(chart.x_title), gnuplot_string(chart.y_title),
             chart.settings) +
         data + plots + "\n";
}

}  // namespace dermis::bench
