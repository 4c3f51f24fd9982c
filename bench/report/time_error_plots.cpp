#include <fmt/format.h>

#include <algorithm>

#include "report/case_curves.hpp"
#include "report/plots.hpp"

namespace dermis::bench {

namespace {

/// What a set of axes shows, and how far in.
struct View {
  std::string title;
  std::string time_label;
  Value time;
  double least_error = 1e-3;  ///< less stands at the foot of the axis
};

/// The rows of dermis that no other beats in both time and error.
Curve front_of(const Measurement& measurement, const View& view, const Choice& belongs) {
  std::vector<Point> points;
  for (const Row& row : measurement.rows) {
    if (row.what.family == Family::dermis && is_default_caller(row) && belongs(row)) {
      points.push_back({view.time(row), *row.rel_l2, ""});
    }
  }
  std::sort(points.begin(), points.end(), by_x);
  Curve front = {.title = "front of dermis", .style = "lines lc rgb '#d3e0ef' lw 9"};
  for (const Point& point : points) {
    if (front.points.empty() || point.y < front.points.back().y) front.points.push_back(point);
  }
  return front;
}

Panel time_error(const Measurement& measurement, const View& view, const SceneSpec& scene) {
  const Choice belongs = [&](const Row& row) { return row.what.scene == scene && row.rel_l2; };
  const auto label = [&](const Row& row) {
    if (*row.rel_l2 < view.least_error) return fmt::format("{:.0e}, below", *row.rel_l2);
    if (row.what.family == Family::dermis_disc) return std::to_string(row.what.disc.samples);
    return row.what.model().empty() ? std::string() : std::to_string(row.what.design.count);
  };
  Panel panel = {.title = view.title,
                 .settings = fmt::format("{}set xlabel '{}'\nset ylabel 'relative L2 error'\n"
                                         "set format y '%g'\nset yrange [{}:*]\nset ytics "
                                         "(0.0002,0.0005,0.001,0.002,0.005,0.01,0.02,0.05,0.1)\nset xtics {}",
                                         axes, view.time_label, view.least_error, round_tics),
                 .curves = curves_of(
                     measurement, belongs, view.time,
                     [&](const Row& row) { return std::max(view.least_error, *row.rel_l2); }, label)};
  panel.curves.insert(panel.curves.begin(), front_of(measurement, view, belongs));
  return panel;
}

Panel time_error_of_picture(const Measurement& measurement) {
  if (measurement.picture.empty()) return {};
  const SceneSpec& scene = measurement.rows.front().what.scene;
  const DeviceInfo& device = measurement.device;
  const View view = {
      .title = fmt::format("{}, {}x{}, against the surface integral; {} threads of {}", measurement.picture,
                           scene.width, scene.height, device.compute_units, device.name),
      .time_label = "time, ms",
      .time = [](const Row& row) { return row.ms; },
      .least_error = 2e-3};
  return time_error(measurement, view, scene);
}

}  // namespace

void draw_time_error(const std::filesystem::path& folder, const Measurement& measurement) {
  const Value time = [](const Row& row) { return row.copy_ratio; };
  const View spheres = {"three spheres, against the surface integral", "time, x copy", time};
  const View flat = {"flat, against exact convolution", "time, x copy", time, 2e-4};
  draw("--plot", folder / "time_error.svg",
       {time_error(measurement, spheres, {}), time_error(measurement, flat, {.geometry = Geometry::flat})}, 1,
       panel_size);
  draw("--plot", folder / "picture_time_error.svg", {time_error_of_picture(measurement)}, 1, {1000, 520});
}

}  // namespace dermis::bench
