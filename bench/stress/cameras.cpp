// Cameras near, far and aside.
#include <algorithm>
#include <cmath>
#include <limits>

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

/// Lights a few pixels, where the kernel does not reach the frame's edges.
StressRow impulses(const StressFilter& filter, StressField field, const std::string& name, int margin_px,
                   std::mt19937& engine) {
  StressRow row{.group = "camera", .name = name, .promised = "sum 1e-05"};
  std::fill(field.light.begin(), field.light.end(), 0.0F);
  for (int i = 0; i < 3; ++i) {
    const auto x = margin_px + static_cast<int>(engine() % static_cast<unsigned>(field.width_px - 2 * margin_px));
    const auto y = margin_px + static_cast<int>(engine() % static_cast<unsigned>(field.height_px - 2 * margin_px));
    for (std::size_t c = 0; c < 3; ++c) {
      field.light[(static_cast<std::size_t>(y) * field.width_px + x) * 3 + c] =
          static_cast<float>(uniform(engine, 1, 9));
    }
  }
  const StressResult seen = filter.run(field);
  double before[3] = {};
  double after[3] = {};
  long lit = 0;
  for (std::size_t i = 0; i < field.light.size(); ++i) {
    before[i % 3] += static_cast<double>(field.light[i]);
    after[i % 3] += seen.values.values[i];
    lit += seen.values.values[i] != 0 ? 1 : 0;
  }
  row.energy = 0;
  for (int c = 0; c < 3; ++c) row.energy = std::max(row.energy, std::abs(after[c] / before[c] - 1));
  if (!(row.energy <= 1e-5)) fail(row, "the sum is off by " + std::to_string(row.energy));
  if (lit < 100) fail(row, "nothing spreads");
  return row;
}

}  // namespace

void add_camera_cases(std::vector<StressRow>& rows, const StressFilter& deep, std::mt19937& engine) {
  const double px_per_mm = uniform(engine, 2, 5);
  const double bump_mm = 2 / px_per_mm;
  rows.push_back(
      judged(deep, stress_surface(engine, 80, 48, 1, 1 / px_per_mm, 0.02 / px_per_mm), "camera", "focal length 1 px"));
  rows.push_back(
      judged(deep, stress_surface(engine, 80, 48, 1e6, 1e6 / px_per_mm, bump_mm), "camera", "focal length 1e6 px"));
  // A float32 holds depths of that size, in mm, to a sixteenth of a pixel only, unless mm_per_unit is a power of two:
  // the oracle's bound says how much of a curved surface is left then.
  constexpr StressPromise far_away{.rel_l2 = std::numeric_limits<double>::infinity(), .sure_values_only = false};
  StressField away = stress_surface(engine, 80, 48, 1e6, 1e6, 3);
  away.mm_per_unit = 1 / px_per_mm;
  rows.push_back(judged(deep, away, "camera", "1e6 units away", far_away));
  StressField aside = stress_surface(engine, 80, 48, 100 * px_per_mm, 100, 0);
  aside.camera.center_x = -1e6 * px_per_mm;
  rows.push_back(judged(deep, aside, "camera", "1e6 units aside", {.sure_values_only = false}));
  StressField plane = stress_surface(engine, 160, 120, 100 * px_per_mm, 100, 0);
  std::fill(plane.depth.begin(), plane.depth.end(), 100.0F);
  rows.push_back(impulses(deep, plane, "impulses on a plane", 50, engine));
}

}  // namespace dermis::bench
