#include <algorithm>
#include <optional>

#include "dermis/error.hpp"
#include "dermis/taps.hpp"
#include "taps/check_design.hpp"

namespace dermis {

double tolerance_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return 0.05;
    case Quality::preview:
      return 0.02;
    case Quality::final:
      return 0.006;
    case Quality::reference:
      break;
  }
  return 0;
}

TapsDesign design_within(double tolerance, TapsDesign design) {
  design.tolerance = tolerance;
  design.rank = 0;
  design.count = 33;
  return design;
}

DesignChoice choose_design(const Profile& profile, const TapsDesign& wanted, double pixel_mm) {
  constexpr int most_fitted_taps = 65;
  if (wanted.tolerance == 0) throw Error(ErrorCode::usage, "tolerance", "0", "above 0 and below 1");
  check_pixel_mm(pixel_mm);
  const int lowest = with_rank(profile, wanted, pixel_mm).rank;
  const int highest = wanted.rank > 0 ? lowest : highest_rank(wanted.model);
  std::optional<DesignChoice> best;
  for (const int count : {wanted.count, std::max(wanted.count, most_fitted_taps)}) {
    for (int rank = count == wanted.count ? lowest : highest; rank <= highest; ++rank) {
      TapsDesign design = wanted;
      design.rank = rank;
      design.count = count;
      // To place the taps of all sizes would take several times as long as the fewest that will do here.
      const double error = make_tap_set(profile, design, pixel_mm).predicted_rel_l2;
      if (!best || error < best->predicted_rel_l2) best = {design, error};
      if (error <= wanted.tolerance) return *best;
    }
  }
  return *best;
}

}  // namespace dermis
