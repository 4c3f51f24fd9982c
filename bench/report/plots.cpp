#include "report/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "dermis/error.hpp"
#include "report/chart.hpp"
#include "report/gnuplot.hpp"

namespace dermis::bench {

namespace {

constexpr std::string_view option = "--plot";
constexpr const char* round_tics = "(0.1,0.2,0.5,1,2,5,10,20,50,100,200,500,1000,2000,5000)";
using Choice = std::function<bool(const Row&)>;
using Value = std::function<double(const Row&)>;

struct Look {
  const char* title;
  const char* colour;
  int point_type;
};

Look look_of(const Case& what) {
  switch (what.family) {
    case Family::texture_gaussians:
      return {"dermis, texture, six Gaussians", "#a3a32a", 8};
    case Family::texture_recursive:
      return {"dermis, texture, recursion", "#d4582a", 10};
    case Family::naive:
      return {"naive OpenCL", "#b5651d", 9};
    case Family::rule_2012:
      return {"rule of 2012, OpenCL", "#8a6d4b", 11};
    case Family::simd:
      return {"C++ vectors, no depth", "#777777", 4};
    case Family::simd_depth:
      return {"C++ vectors, depth", "#333333", 5};
    case Family::opencv_separable:
      return {"OpenCV sepFilter2D", "#2a8f6f", 13};
    case Family::opencv_bilateral:
      return {"OpenCV bilateral", "#6abf9f", 12};
    case Family::fft:
      return {"FFTW, exact", "#7a4fa3", 3};
    case Family::dermis_disc:
      return what.disc.prefiltered ? Look{"dermis, discs, prefiltered", "#c23b3b", 10}
                                   : Look{"dermis, discs", "#e58a8a", 8};
    default:
      break;
  }
  if (what.design.model == Model::pre_integrated) return {"dermis, importance-sampled", "#e08e1b", 6};
  if (what.design.model == Model::gaussians) return {"dermis, Gaussians", "#c77ca5", 6};
  if (what.tolerance > 0) return {"dermis, 1 % predicted", "#e0457b", 15};
  constexpr Look ranks[] = {
      {"dermis, rank 1", "#7fb2e5", 7}, {"dermis, rank 2", "#2f6db5", 7}, {"dermis, rank 3", "#123d73", 7}};
  return ranks[std::clamp(what.design.rank, 1, 3) - 1];
}

bool is_default_caller(const Row& row) {
  return row.what.threads == 0 && row.what.memory == Memory::planar_f32 && row.ms > 0 &&
         row.what.family != Family::start_up && row.what.family != Family::dermis_exact;
}

bool is_default_method(const Case& what) {
  return what.family != Family::dermis || (what.tolerance == 0 && what.design == TapsDesign{.rank = 2});
}

/// One line per look, in the order of the rows.
std::vector<Series> series_of(const Measurement& measurement, const Choice& belongs, const Value& x, const Value& y,
                              const std::function<std::string(const Row&)>& label) {
  std::vector<Series> all;
  for (const Row& row : measurement.rows) {
    if (!is_default_caller(row) || !belongs(row)) continue;
    const Look look = look_of(row.what);
    auto its = std::find_if(all.begin(), all.end(), [&](const Series& one) { return one.title == look.title; });
    if (its == all.end()) {
      all.push_back({.title = look.title, .colour = look.colour, .point_type = look.point_type});
      its = all.end() - 1;
    }
    its->points.push_back({x(row), y(row), label(row)});
  }
  for (Series& series : all) {
    std::sort(series.points.begin(), series.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  }
  return all;
}

std::string no_label(const Row&) { return ""; }

/// What no other row of dermis beats in both time and error.
Series front_of(const Measurement& measurement, const Choice& belongs) {
  std::vector<ChartPoint> points;
  for (const Row& row : measurement.rows) {
    if (row.what.family == Family::dermis && is_default_caller(row) && belongs(row)) {
      points.push_back({row.copy_ratio, *row.rel_l2, ""});
    }
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  Series front = {.title = "front of dermis", .colour = "#d3e0ef", .style = "lines", .line_width = 9, .points = {}};
  for (const ChartPoint& point : points) {
    if (front.points.empty() || point.y < front.points.back().y) front.points.push_back(point);
  }
  return front;
}

Chart time_error(const Measurement& measurement, Geometry geometry) {
  const double least_error = geometry == Geometry::flat ? 2e-4 : 1e-3;  // what is less stands at the foot of the axis
  SceneSpec scene;
  scene.geometry = geometry;
  const Choice belongs = [&](const Row& row) { return row.what.scene == scene && row.rel_l2; };
  Chart chart = {.title = geometry == Geometry::flat ? "flat, against exact convolution"
                                                     : "three spheres, against the surface integral",
                 .x_title = "time, x copy",
                 .y_title = "relative L2 error",
                 .settings = fmt::format("set format y '%g'\nset yrange [{}:*]\nset ytics "
                                         "(0.0002,0.0005,0.001,0.002,0.005,0.01,0.02,0.05,0.1)\nset xtics {}",
                                         least_error, round_tics),
                 .series = {front_of(measurement, belongs)}};
  const auto taps = [&](const Row& row) {
    if (*row.rel_l2 < least_error) return fmt::format("{:.0e}, below", *row.rel_l2);
    return row.what.model().empty() ? std::string() : std::to_string(row.what.design.count);
  };
  for (Series& series : series_of(
           measurement, belongs, [](const Row& row) { return row.copy_ratio; },
           [&](const Row& row) { return std::max(least_error, *row.rel_l2); }, taps)) {
    series.labels_below = series.title == "dermis, rank 1" || series.title == "dermis, rank 3";
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Time over something else. `belongs` picks the rows.
Chart cost(const Measurement& measurement, const std::string& title, const std::string& x_title,
           const std::string& settings, const Choice& belongs, const Value& x) {
  return {.title = title,
          .x_title = x_title,
          .y_title = "time, ms",
          .settings = fmt::format("{}\nset ytics {}", settings, round_tics),
          .series = series_of(
              measurement, belongs, x, [](const Row& row) { return row.ms; }, no_label)};
}

Chart cost_width(const Measurement& measurement, Geometry geometry) {
  const auto belongs = [geometry](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.kernel_px = SceneSpec().kernel_px;
    const bool is_scene = scene == SceneSpec{.geometry = geometry};
    const bool is_method = row.what.tolerance > 0 || is_default_method(row.what);
    return is_scene && is_method && row.what.design.count == (row.what.tolerance > 0 ? row.what.design.count : 17) &&
           row.what.family != Family::opencv_bilateral;
  };
  return cost(measurement, geometry == Geometry::flat ? "flat, 1920x1080" : "three spheres, 1920x1080",
              "standard deviation of the widest Gaussian, px", "set xtics (8,16,32,64,120)\nset xrange [7:137]",
              belongs, [](const Row& row) { return row.what.scene.kernel_px; });
}

Chart cost_coverage(const Measurement& measurement) {
  const auto belongs = [](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.coverage_percent = 100;
    return scene == SceneSpec() && is_default_method(row.what) && row.what.design.count == 17 &&
           row.what.family != Family::rule_2012;
  };
  // Nothing at all stands at the left edge of the logarithmic axis.
  static constexpr double nothing = 0.3;
  Chart chart = cost(measurement, "three spheres, 1920x1080, 17 taps; below 100 % in place", "pixels that scatter, %",
                     "set xtics ('0' 0.3,1,10,50,100)\nset xrange [0.25:130]", belongs,
                     [](const Row& row) { return std::max<double>(nothing, row.what.scene.coverage_percent); });
  for (const Row& row : measurement.rows) {
    if (row.what.family != Family::dermis || !belongs(row) || row.what.scene != SceneSpec()) continue;
    chart.series.push_back({.title = "in proportion to the pixels",
                            .colour = "#999999",
                            .style = "lines",
                            .dash_type = 2,
                            .points = {{1, row.ms / 100, ""}, {100, row.ms, ""}}});
    break;
  }
  return chart;
}

Chart cost_pixels(const Measurement& measurement) {
  const auto belongs = [](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.width = SceneSpec().width;
    scene.height = SceneSpec().height;
    const bool is_flat_one = row.what.family == Family::simd_depth;
    return scene == SceneSpec{.geometry = is_flat_one ? Geometry::flat : Geometry::spheres} &&
           is_default_method(row.what) && row.what.design.count == 17 && row.what.family != Family::rule_2012;
  };
  const auto megapixels = [](const Row& row) { return 1e-6 * row.what.scene.width * row.what.scene.height; };
  Chart chart = cost(measurement, "full coverage, 17 taps", "frame, px",
                     "set xtics ('960x540' 0.5184,'1920x1080' 2.0736,'3840x2160' 8.2944)\nset xrange [0.45:9.5]",
                     belongs, megapixels);
  Series copy = {.title = "copy", .colour = "#999999", .dash_type = 2, .points = {}};
  for (const auto& [size, ms] : measurement.copy_ms) {
    if (size.first >= 960) copy.points.push_back({1e-6 * size.first * size.second, ms, ""});
  }
  chart.series.push_back(copy);
  return chart;
}

bool has_points(const Chart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(), [](const Series& one) { return !one.points.empty(); });
}

void draw(const std::filesystem::path& path, std::vector<Chart> charts) {
  std::erase_if(charts, [](const Chart& chart) { return !has_points(chart); });
  if (charts.empty()) return;
  constexpr int width_px = 860;
  constexpr int height_px = 480;
  const int rows = static_cast<int>(charts.size());
  std::string script = fmt::format("set multiplot layout {},1\n", rows);
  for (const Chart& chart : charts) script += script_of(chart);
  draw_svg(option, path, width_px, height_px * rows, script + "unset multiplot");
}

}  // namespace

void prepare_plots(const std::filesystem::path& folder) {
  need_gnuplot(option);
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw Error(ErrorCode::output, option, folder.string(), "a folder, or a name for one in a folder that is there");
  }
}

void draw_plots(const std::filesystem::path& folder, const Measurement& measurement) {
  draw(folder / "time_error.svg",
       {time_error(measurement, Geometry::spheres), time_error(measurement, Geometry::flat)});
  draw(folder / "cost_width.svg",
       {cost_width(measurement, Geometry::flat), cost_width(measurement, Geometry::spheres)});
  draw(folder / "cost_coverage.svg", {cost_coverage(measurement)});
  draw(folder / "cost_pixels.svg", {cost_pixels(measurement)});
}

}  // namespace dermis::bench
