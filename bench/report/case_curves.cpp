#include "report/case_curves.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dermis::bench {

namespace {

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
  if (!what.sheared) {
    return what.design.rank == 1 ? Look{"dermis, rank 1, plain passes", "#5fb8b0", 6}
                                 : Look{"dermis, rank 2, plain passes", "#2f8f88", 4};
  }
  if (what.tolerance > 0) return {"dermis, 1 % predicted", "#e0457b", 15};
  constexpr Look ranks[] = {
      {"dermis, rank 1", "#7fb2e5", 7}, {"dermis, rank 2", "#2f6db5", 7}, {"dermis, rank 3", "#123d73", 7}};
  return ranks[std::clamp(what.design.rank, 1, 3) - 1];
}

}  // namespace

std::string line_style(std::string_view colour, int point_type, int dash_type) {
  return fmt::format("linespoints lc rgb '{}' lw 1.8 dt {} pt {} ps 0.8", colour, dash_type, point_type);
}

std::string label_style(std::string_view colour, bool is_below) {
  return fmt::format("tc rgb '{}' font ',10' offset 0,{}", colour, is_below ? -0.75 : 0.75);
}

bool by_x(const Point& a, const Point& b) { return a.x < b.x; }

bool is_default_caller(const Row& row) {
  const Case& what = row.what;
  return what.threads == 0 && what.memory == Memory::planar_f32 && what.jitter == 0 && row.ms > 0 &&
         what.family != Family::start_up && what.family != Family::dermis_exact;
}

std::vector<Curve> curves_of(const Measurement& measurement, const Choice& belongs, const Value& x, const Value& y,
                             const std::function<std::string(const Row&)>& label) {
  std::vector<Curve> all;
  for (const Row& row : measurement.rows) {
    if (!is_default_caller(row) || !belongs(row)) continue;
    const Look look = look_of(row.what);
    auto its = std::find_if(all.begin(), all.end(), [&](const Curve& one) { return one.title == look.title; });
    if (its == all.end()) {
      const bool is_below =
          look.title == std::string_view("dermis, rank 1") || look.title == std::string_view("dermis, rank 3");
      all.push_back({.title = look.title,
                     .style = line_style(look.colour, look.point_type),
                     .label_style = label_style(look.colour, is_below)});
      its = all.end() - 1;
    }
    its->points.push_back({x(row), y(row), label(row)});
  }
  for (Curve& curve : all) std::sort(curve.points.begin(), curve.points.end(), by_x);
  return all;
}

}  // namespace dermis::bench
