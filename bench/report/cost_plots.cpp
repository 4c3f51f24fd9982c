#include <fmt/format.h>

#include <algorithm>

#include "report/case_curves.hpp"
#include "report/plots.hpp"

namespace dermis::bench {

namespace {

bool is_default_method(const Case& what) {
  return what.family != Family::dermis || (what.tolerance == 0 && what.sheared && what.design == TapsDesign{.rank = 2});
}

/// Time over something else, of the rows that `belongs` picks.
Panel cost(const Measurement& measurement, const std::string& title, const std::string& settings, const Choice& belongs,
           const Value& x) {
  return {.title = title,
          .settings = fmt::format("{}set ylabel 'time, ms'\nset ytics {}\n{}", axes, round_tics, settings),
          .curves = curves_of(
              measurement, belongs, x, [](const Row& row) { return row.ms; }, [](const Row&) { return ""; })};
}

Panel cost_width(const Measurement& measurement, Geometry geometry) {
  const auto belongs = [geometry](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.kernel_px = SceneSpec().kernel_px;
    const bool is_scene = scene == SceneSpec{.geometry = geometry};
    const bool is_method = row.what.tolerance > 0 || is_default_method(row.what);
    return is_scene && is_method && row.what.design.count == (row.what.tolerance > 0 ? row.what.design.count : 17) &&
           row.what.family != Family::opencv_bilateral;
  };
  return cost(
      measurement, geometry == Geometry::flat ? "flat, 1920x1080" : "three spheres, 1920x1080",
      "set xlabel 'standard deviation of the widest Gaussian, px'\nset xtics (8,16,32,64,120)\nset xrange [7:137]",
      belongs, [](const Row& row) { return row.what.scene.kernel_px; });
}

Panel cost_coverage(const Measurement& measurement) {
  const auto belongs = [](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.coverage_percent = 100;
    return scene == SceneSpec() && is_default_method(row.what) && row.what.design.count == 17 &&
           row.what.family != Family::rule_2012;
  };
  // 0 stands at the left edge of the logarithmic axis.
  static constexpr double nothing = 0.3;
  Panel panel =
      cost(measurement, "three spheres, 1920x1080, 17 taps; below 100 % in place",
           "set xlabel 'pixels that scatter, %'\nset xtics ('0' 0.3,1,10,50,100)\nset xrange [0.25:130]", belongs,
           [](const Row& row) { return std::max<double>(nothing, row.what.scene.coverage_percent); });
  for (const Row& row : measurement.rows) {
    if (row.what.family != Family::dermis || !belongs(row) || row.what.scene != SceneSpec()) continue;
    panel.curves.push_back({.title = "in proportion to the pixels",
                            .style = "lines lc rgb '#999999' lw 1.8 dt 2",
                            .points = {{1, row.ms / 100}, {100, row.ms}}});
    break;
  }
  return panel;
}

Panel cost_pixels(const Measurement& measurement) {
  const auto belongs = [](const Row& row) {
    SceneSpec scene = row.what.scene;
    scene.width = SceneSpec().width;
    scene.height = SceneSpec().height;
    const bool is_flat_one = row.what.family == Family::simd_depth;
    return scene == SceneSpec{.geometry = is_flat_one ? Geometry::flat : Geometry::spheres} &&
           is_default_method(row.what) && row.what.design.count == 17 && row.what.family != Family::rule_2012;
  };
  const auto megapixels = [](const Row& row) { return 1e-6 * row.what.scene.width * row.what.scene.height; };
  Panel panel = cost(measurement, "full coverage, 17 taps",
                     "set xlabel 'frame, px'\nset xtics ('960x540' 0.5184,'1920x1080' 2.0736,'3840x2160' 8.2944)\nset "
                     "xrange [0.45:9.5]",
                     belongs, megapixels);
  Curve copy = {.title = "copy", .style = line_style("#999999", 7, 2)};
  for (const auto& [size, ms] : measurement.copy_ms) {
    if (size.first >= 960) copy.points.push_back({1e-6 * size.first * size.second, ms});
  }
  panel.curves.push_back(copy);
  return panel;
}

}  // namespace

void draw_costs(const std::filesystem::path& folder, const Measurement& measurement) {
  const auto draw_one = [&](const char* name, const std::vector<Panel>& panels) {
    draw("--plot", folder / name, panels, 1, panel_size);
  };
  draw_one("cost_width.svg", {cost_width(measurement, Geometry::flat), cost_width(measurement, Geometry::spheres)});
  draw_one("cost_coverage.svg", {cost_coverage(measurement)});
  draw_one("cost_pixels.svg", {cost_pixels(measurement)});
}

}  // namespace dermis::bench
