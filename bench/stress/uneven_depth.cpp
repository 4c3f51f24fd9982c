// Depth that changes from pixel to pixel.
#include <cmath>

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

constexpr const char* group = "depth";

/// A pixel whose only neighbour of its material is far behind it passes for a piece of surface as long as that gap. The
/// mean is divided by the weights, and the corrections of rank 2 by as much. They still give and take several times as
/// much light as on a plane (11 in 18 seeds); an error that grows with the gap would overshoot by 800 and more.
constexpr StressPromise long_segments{.overshoot = 100, .white_within_bound = true};

/// Red light on one half of a checkerboard, blue on the other, so far apart that the profile does not reach.
StressRow far_apart(const StressFilter& deep, StressField field) {
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    const auto x = static_cast<int>(i) % field.width_px;
    const auto y = static_cast<int>(i) / field.width_px;
    const bool is_near = (x + y) % 2 == 0;
    field.depth[i] = is_near ? 100 : 1000;
    field.light[3 * i + (is_near ? 2 : 0)] = 0;
  }
  StressRow row = judged(deep, field, group, "checkerboard far apart", long_segments);
  row.promised += ", no light across";
  const StressResult seen = deep.run(field);
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    if (seen.values.values[3 * i + (field.depth[i] == 100 ? 2 : 0)] != 0) {
      fail(row, "light crosses");
      break;
    }
  }
  return row;
}

}  // namespace

void add_depth_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine) {
  StressField field = stress_surface(engine, 80, 48, 400, 100, 1);
  rows.push_back(missing_depth(deep, field, engine));
  rows.push_back(judged(deep, field, group, "bumps"));
  rows.push_back(far_apart(deep, field));
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    const auto x = static_cast<int>(i) % field.width_px;
    const auto y = static_cast<int>(i) / field.width_px;
    field.depth[i] = (x + y) % 2 == 0 ? 100.0F : 100.5F;
  }
  rows.push_back(judged(deep, field, group, "checkerboard 0.5 mm apart"));
  for (float& depth : field.depth) depth = static_cast<float>(100 * std::pow(10.0, uniform(engine, -2, 2)));
  rows.push_back(judged(deep, field, group, "noise over four decades", long_segments));
}

}  // namespace dermis::bench
