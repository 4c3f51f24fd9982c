#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "taps/designed_taps.hpp"

namespace dermis {

namespace {

int cost(const TapsDesign& design) { return (1 + design.rank) * design.count; }

/// By ascending cost; of equal cost the higher rank first, which is better where both will do.
std::vector<TapsDesign> candidates() {
  std::vector<TapsDesign> designs;
  for (int rank = 1; rank <= 3; ++rank) {
    for (const int count : {5, 7, 9, 11, 13, 17, 21, 25, 33, 41, 49, 65}) {
      designs.push_back({.model = Model::optimised, .rank = rank, .count = count, .placement = Placement::optimised});
    }
  }
  std::stable_sort(designs.begin(), designs.end(), [](const TapsDesign& a, const TapsDesign& b) {
    return cost(a) != cost(b) ? cost(a) < cost(b) : a.rank > b.rank;
  });
  return designs;
}

}  // namespace

std::optional<TapsDesign> cheapest_design(const Profile& profile, double tolerance, double pixel_mm) {
  if (!(tolerance > 0)) throw Error(ErrorCode::usage, "tolerance", std::to_string(tolerance), "above 0");
  // More taps are not worse, so a rank whose most taps do not do is out.
  int lowest_rank = 1;
  for (; lowest_rank <= 3; ++lowest_rank) {
    const TapsDesign best{
        .model = Model::optimised, .rank = lowest_rank, .count = 65, .placement = Placement::optimised};
    if (make_tap_set(profile, best, pixel_mm).predicted_rel_l2 <= tolerance) break;
  }
  for (const TapsDesign& design : candidates()) {
    if (design.rank < lowest_rank) continue;
    if (make_tap_set(profile, design, pixel_mm).predicted_rel_l2 <= tolerance) return design;
  }
  return std::nullopt;
}

}  // namespace dermis
