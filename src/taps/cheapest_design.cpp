#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "dermis/error.hpp"
#include "dermis/taps.hpp"

namespace dermis {

namespace {

constexpr std::array counts{5, 7, 9, 11, 13, 17, 21, 25, 33, 41, 49, 65};

int reads(const TapsDesign& design) { return (1 + design.rank) * design.count; }

/// The fewest taps of a rank that meet the tolerance, by bisection: more taps are not worse.
std::optional<TapsDesign> cheapest_of_rank(const Profile& profile, int rank, double tolerance, double pixel_mm) {
  const auto design = [&](int count) { return TapsDesign{.rank = rank, .count = count}; };
  const auto does_not_do = [&](int count) {
    return make_tap_set(profile, design(count), pixel_mm).predicted_rel_l2 > tolerance;
  };
  const auto* fewest = std::partition_point(counts.begin(), counts.end(), does_not_do);
  return fewest == counts.end() ? std::nullopt : std::optional(design(*fewest));
}

}  // namespace

std::optional<TapsDesign> cheapest_design(const Profile& profile, double tolerance, double pixel_mm) {
  if (!(tolerance > 0)) throw Error(ErrorCode::usage, "tolerance", std::to_string(tolerance), "above 0");
  std::optional<TapsDesign> cheapest;
  for (int rank = 1; rank <= 3; ++rank) {
    const auto design = cheapest_of_rank(profile, rank, tolerance, pixel_mm);
    // At equal cost the higher rank is better.
    if (design && (!cheapest || reads(*design) <= reads(*cheapest))) cheapest = design;
  }
  return cheapest;
}

}  // namespace dermis
