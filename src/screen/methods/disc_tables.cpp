#include "screen/methods/disc_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis {

namespace {

/// Kernels within 4 x 4 pixels have few samples, wide ones the usual number (Golubev 2018).
constexpr int few_samples = 21;
constexpr int usual_samples = 55;

}  // namespace

params::DiscCounts disc_counts(const DiscOptions& options, std::uint32_t seed) {
  if (options.samples > 0) return {{0, options.samples}, options.accumulate, seed};
  return {{few_samples, usual_samples}, options.accumulate, seed};
}

void append_disc(const Profile& profile, int channel, const DiscOptions& options,
                 std::vector<params::DiscParams>& discs, std::vector<params::SampleParams>& samples) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  const params::DiscCounts counts = disc_counts(options, 0);
  params::DiscParams disc{};
  double reach_mm = 0;
  for (int which = 0; which < 2; ++which) {
    disc.first_sample[which] = static_cast<int>(samples.size());
    const int count = counts.samples[which];
    for (int start = 0; start < DISC_STARTS && count > 0; ++start) {
      const double from = static_cast<double>(start) / DISC_STARTS;
      const double share = (1 - from) / count;
      for (int i = 0; i < count; ++i) {
        const double r_mm = profile.radius(channel, from + share * (i + 0.5));
        const double area_mm2 = share / profile.radial(channel, r_mm);
        const double spacing_mm = std::sqrt(area_mm2);
        const double angle = golden_angle * i;
        samples.push_back({static_cast<float>(r_mm * std::cos(angle)), static_cast<float>(r_mm * std::sin(angle)),
                           static_cast<float>(area_mm2), static_cast<float>(spacing_mm)});
        if (i == 0) disc.inner_mm[which][start] = static_cast<float>(profile.radius(channel, from) + spacing_mm / 2);
        // Squares of pixels that a sample reads end one and a half of their sides away at most.
        reach_mm = std::max(reach_mm, r_mm + (options.prefiltered ? 1.5 * spacing_mm : 0));
      }
    }
  }
  disc.reach_mm = static_cast<float>(reach_mm);
  discs.push_back(disc);
}

}  // namespace dermis
