// Scales, depths and light at the ends of what a float holds, for every method.
#include <algorithm>
#include <cmath>
#include <utility>

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

/// A method, and a word for it.
struct Named {
  std::string name;
  Options options;
};

StressField with_scale(StressField field, double mm_per_unit) {
  field.mm_per_unit = mm_per_unit;
  return field;
}

StressField with_depths(StressField field, float even, float odd) {
  for (std::size_t i = 0; i < field.pixels(); ++i)
    field.depth[i] =
        (i % static_cast<std::size_t>(field.width_px) + i / static_cast<std::size_t>(field.width_px)) % 2 == 0 ? even
                                                                                                               : odd;
  return field;
}

StressField with_factor(StressField field, double factor) {
  for (float& value : field.light) value = static_cast<float>(value * factor);
  return field;
}

long count_non_finite(const StressResult& result) {
  return static_cast<long>(std::count_if(result.values.values.begin(), result.values.values.end(),
                                         [](double value) { return !std::isfinite(value); }));
}

/// Finite light stays finite, and within its range; the same light everywhere stays so to 1e-4.
StressRow finite(const StressFilter& filter, StressField field, const std::string& group, const std::string& name) {
  StressRow row{.group = group, .name = name, .promised = "finite, white 1e-04"};
  const StressResult seen = filter.run(field);
  const double white = static_cast<double>(*std::max_element(field.light.begin(), field.light.end()));
  std::fill(field.light.begin(), field.light.end(), static_cast<float>(white));
  const StressResult even = filter.run(field);
  row.non_finite = count_non_finite(seen) + count_non_finite(even);
  row.energy = 0;
  for (const double value : even.values.values) row.energy = std::max(row.energy, std::abs(value / white - 1));
  if (row.non_finite > 0) fail(row, std::to_string(row.non_finite) + " values are not finite");
  if (!(row.energy <= 1e-4)) fail(row, "white changes by " + std::to_string(row.energy));
  return row;
}

}  // namespace

void add_method_cases(std::vector<StressRow>& rows, const Device& device, std::mt19937& engine) {
  const TapsDesign few{.model = Model::pre_integrated, .count = 9, .placement = Placement::importance};
  TapsDesign corrected = few;
  corrected.model = Model::optimised;
  corrected.rank = 3;
  const std::vector<Named> methods = {{"rank 3", {.taps = corrected}},
                                      {"exact", {.method = Method::exact, .taps = few}},
                                      {"disc", {.method = Method::disc, .taps = few, .disc = {.samples = 21}}}};
  const StressField surface = stress_surface(engine, 24, 18, 55, 10, 0.2);
  for (const auto& [name, options] : methods) {
    const StressFilter filter(device, {{0, preset("skin").profile}}, {.depth = true}, options);
    for (const int decade : {-12, -6, 6, 12})
      rows.push_back(finite(filter, with_scale(surface, std::pow(10.0, decade)), "camera",
                            name + ", 1e" + std::to_string(decade) + " mm per unit"));
    rows.push_back(finite(filter, with_depths(surface, 1e-38F, 1e-38F), "depth", name + ", 1e-38"));
    rows.push_back(finite(filter, with_depths(surface, 1e-30F, 1e30F), "depth", name + ", 1e-30 beside 1e30"));
    rows.push_back(finite(filter, with_depths(surface, 1e-12F, 9e8F), "depth", name + ", 1e-12 beside 9e8"));
    for (const int decade : {-30, 30, 31})
      rows.push_back(finite(filter, with_factor(surface, std::pow(10.0, decade)), "light",
                            name + ", 1e" + std::to_string(decade)));
    rows.push_back(
        finite(filter, with_scale(with_factor(surface, 1e-30), 1e-12), "light", name + ", 1e-30 at 1e-12 mm per unit"));
    rows.push_back(finite(filter, with_factor(surface, 2e38), "light", name + ", 3e38"));
  }
}

}  // namespace dermis::bench
