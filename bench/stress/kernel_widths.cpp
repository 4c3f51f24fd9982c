// Profiles of any width.
#include <cmath>

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

/// A surface in upright stripes, each of one material.
StressField striped(std::mt19937& engine, int materials) {
  constexpr int stripe_px = 24;
  StressField field = stress_surface(engine, materials * stripe_px, 40, 300, 100, 0);
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    const auto stripe = static_cast<int>(i) % field.width_px / stripe_px;
    field.ids.push_back(static_cast<float>(stripe + 1));
  }
  return field;
}

}  // namespace

void add_width_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine) {
  std::vector<Material> materials;
  std::vector<double> d_mm;
  for (int i = 0; i < 5; ++i) {
    d_mm.push_back(std::pow(10.0, 3 * i - 6));
    materials.push_back({i + 1, Profile::burley({d_mm[i], 0.6 * d_mm[i], 0.3 * d_mm[i]})});
  }
  const Options options{.taps = {.model = Model::pre_integrated, .placement = Placement::importance}};
  const StressFilter filter(device, materials, {.depth = true, .material = true}, options);
  StressField field = striped(engine, 5);
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    if (field.depth[i] < 1e9F)
      field.depth[i] = static_cast<float>(100 * d_mm[static_cast<std::size_t>(field.ids[i]) - 1]);
  }
  rows.push_back(judged(filter, field, "profile", "d 1e-6 to 1e6 mm, 3 px"));
  field = striped(engine, 5);
  rows.push_back(judged(filter, field, "profile", "d 1e-6 to 1e6 mm, 100 mm away"));
}

}  // namespace dermis::bench
