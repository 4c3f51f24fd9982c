#include "oracle/integral/disc_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::oracle {

namespace {

/// Finds by bisection the radius at which the cdf reaches a share.
double radius(const Material& material, int channel, double share) {
  double low = 0;
  double high = 1;
  while (material.cdf(channel, high) < share) high *= 2;
  while (low < 0.5 * high && high > 1e-12) {
    if (material.cdf(channel, 0.5 * high) < share) {
      low = 0.5 * high;
    } else {
      high *= 0.5;
    }
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (material.cdf(channel, middle) < share ? low : high) = middle;
  }
  return share > 0 ? 0.5 * (low + high) : 0;
}

}  // namespace

std::vector<DiscSet> make_disc_sets(const Material& material, int count) {
  const auto& widths = material.taps.relative_width;
  const auto channel = static_cast<int>(std::max_element(widths.begin(), widths.end()) - widths.begin());
  std::vector<DiscSet> sets;
  for (int start = 0; start < disc_starts && count > 0; ++start) {
    const double from = static_cast<double>(start) / disc_starts;
    DiscSet set{};
    for (int i = 0; i < count; ++i) {
      const double r = radius(material, channel, from + (1 - from) * (i + 0.5) / count);
      const double spacing = std::sqrt((1 - from) / (count * material.radial(channel, r)));
      const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
      set.samples.push_back({r * std::cos(angle), r * std::sin(angle), spacing});
    }
    set.inner_mm = radius(material, channel, from) + set.samples.front().spacing_mm / 2;
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace dermis::oracle
