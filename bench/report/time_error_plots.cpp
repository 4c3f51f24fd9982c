#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "report/case_curves.hpp"
#include "report/plots.hpp"

namespace dermis::bench {

namespace {

constexpr const char* picture_colours[] = {"#d1495b", "#2f6db5", "#2a8f6f", "#e08e1b", "#7a4fa3"};

/// The rows of dermis that no other beats in both time and error.
Curve front_of(const Measurement& measurement, const Choice& belongs) {
  std::vector<Point> points;
  for (const Row& row : measurement.rows) {
    if (row.what.family == Family::dermis && is_default_caller(row) && belongs(row)) {
      points.push_back({row.copy_ratio, *row.rel_l2, ""});
    }
  }
  std::sort(points.begin(), points.end(), by_x);
  Curve front = {.title = "front of dermis", .style = "lines lc rgb '#d3e0ef' lw 9"};
  for (const Point& point : points) {
    if (front.points.empty() || point.y < front.points.back().y) front.points.push_back(point);
  }
  return front;
}

Panel time_error(const Measurement& measurement, Geometry geometry) {
  const double least_error = geometry == Geometry::flat ? 2e-4 : 1e-3;  // less stands at the foot of the axis
  SceneSpec scene;
  scene.geometry = geometry;
  const Choice belongs = [&](const Row& row) { return row.what.scene == scene && row.rel_l2; };
  const auto label = [&](const Row& row) {
    if (*row.rel_l2 < least_error) return fmt::format("{:.0e}, below", *row.rel_l2);
    return row.what.model().empty() ? std::string() : std::to_string(row.what.design.count);
  };
  Panel panel = {.title = geometry == Geometry::flat ? "flat, against exact convolution"
                                                     : "three spheres, against the surface integral",
                 .settings = fmt::format("{}set xlabel 'time, x copy'\nset ylabel 'relative L2 error'\n"
                                         "set format y '%g'\nset yrange [{}:*]\nset ytics "
                                         "(0.0002,0.0005,0.001,0.002,0.005,0.01,0.02,0.05,0.1)\nset xtics {}",
                                         axes, least_error, round_tics),
                 .curves = curves_of(
                     measurement, belongs, [](const Row& row) { return row.copy_ratio; },
                     [&](const Row& row) { return std::max(least_error, *row.rel_l2); }, label)};
  panel.curves.insert(panel.curves.begin(), front_of(measurement, belongs));
  return panel;
}

/// One curve per material and series of cases.
Panel time_error_of_picture(const Measurement& measurement) {
  std::vector<std::string> series;
  for (const Row& row : measurement.rows) {
    const std::string its = row.what.series();
    if (!its.empty() && std::find(series.begin(), series.end(), its) == series.end()) series.push_back(its);
  }
  const DeviceInfo& device = measurement.device;
  Panel panel = {.title = {}, .settings = {}};
  double shortest = HUGE_VAL, longest = 0, least = HUGE_VAL, most = 0;
  // The last part is what lies near edges.
  for (std::size_t i = 0; i + 1 < measurement.parts.size(); ++i) {
    if (measurement.parts[i].pixels == 0) continue;
    for (std::size_t k = 0; k < series.size(); ++k) {
      const char* colour = picture_colours[i % std::size(picture_colours)];
      Curve curve = {.title = measurement.parts[i].name + ", " + series[k],
                     .style = line_style(colour, 5 + 2 * static_cast<int>(i % 3), 1 + static_cast<int>(k)),
                     .label_style = label_style(colour)};
      for (const Row& row : measurement.rows) {
        const Case& what = row.what;
        if (what.series() != series[k]) continue;
        const int count = what.family == Family::dermis_disc ? what.disc.samples : what.design.count;
        const double error = row.rel_l2_of_parts[i];
        curve.points.push_back({row.ms, error, std::to_string(count)});
        shortest = std::min(shortest, row.ms);
        longest = std::max(longest, row.ms);
        least = std::min(least, error);
        most = std::max(most, error);
      }
      panel.curves.push_back(std::move(curve));
    }
  }
  if (panel.curves.empty()) return panel;  // --filter left no case of a series
  const SceneSpec& scene = measurement.rows.front().what.scene;
  panel.title = fmt::format("{}, {}x{}, {} threads of {}", measurement.picture, scene.width, scene.height,
                            device.compute_units, device.name);
  panel.settings = fmt::format(
      "{}set xlabel 'time, ms'\nset ylabel 'relative L2 error against exact'\nset format y '%g'\n"
      "set ytics (0.003,0.005,0.007,0.01,0.015,0.02,0.03,0.05,0.1)\n"
      "set xtics (2,3,5,7,10,15,20,30,40,50,70,100,150,200,300)\nset xrange [{}:{}]\nset yrange [{}:{}]",
      axes, shortest * 0.9, longest * 1.1, least * 0.9, most * 1.2);
  return panel;
}

}  // namespace

void draw_time_error(const std::filesystem::path& folder, const Measurement& measurement) {
  draw("--plot", folder / "time_error.svg",
       {time_error(measurement, Geometry::spheres), time_error(measurement, Geometry::flat)}, 1, panel_size);
  draw("--plot", folder / "picture_time_error.svg", {time_error_of_picture(measurement)}, 1, {1100, 600});
}

}  // namespace dermis::bench
