#include "dermis/taps.hpp"
#include "taps/check_design.hpp"
#include "taps/designed_taps.hpp"

namespace dermis {

TapsDesign with_rank(const Profile& profile, const TapsDesign& design, double pixel_mm) {
  check_design(design);
  if (pixel_mm != 0) check_pixel_mm(pixel_mm);
  if (design.rank > 0) return design;
  constexpr double usual_radius_px = 64;
  constexpr double share_of_model = 0.75;
  const int highest = highest_rank(design.model);
  TapsDesign result = design;
  for (result.rank = 1; result.rank < highest; ++result.rank) {
    const DesignedTaps designed(profile, result);
    const double size_mm = pixel_mm > 0 ? pixel_mm : designed.radius_mm() / usual_radius_px;
    if (designed.model_rel_l2(size_mm) <= share_of_model * design.tolerance) break;
  }
  return result;
}

}  // namespace dermis
