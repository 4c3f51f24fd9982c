#include "taps/check_design.hpp"

#include <sstream>
#include <string>

#include "dermis/error.hpp"

namespace dermis {

int highest_rank(Model model) {
  switch (model) {
    case Model::svd:
    case Model::gaussians:
      return 6;
    case Model::optimised:
      return 3;
    case Model::pre_integrated:
    case Model::artist:
    case Model::guided:
      break;
  }
  return 1;
}

void check_design(const TapsDesign& design) {
  const int ranks = highest_rank(design.model);
  if (!(design.tolerance >= 0 && design.tolerance < 1)) {
    throw Error(ErrorCode::usage, "tolerance", std::to_string(design.tolerance), "at least 0 and below 1");
  }
  const bool automatic = design.rank == 0 && design.tolerance > 0;
  if (!automatic && (design.rank < 1 || design.rank > ranks)) {
    throw Error(ErrorCode::usage, "rank", std::to_string(design.rank),
                (ranks == 1 ? "1" : "1.." + std::to_string(ranks)) + " for this model");
  }
  if (design.count < 3 || design.count > most_taps || design.count % 2 == 0) {
    throw Error(ErrorCode::usage, "taps", std::to_string(design.count), "an odd number, 3..2047");
  }
  if (design.widest_px < 64 || design.widest_px > 512) {
    throw Error(ErrorCode::usage, "widest_px", std::to_string(design.widest_px), "64..512");
  }
  if (!(design.guide >= 0 && design.guide <= 4)) {
    throw Error(ErrorCode::usage, "guide", std::to_string(design.guide), "0..4");
  }
}

void check_pixel_mm(double pixel_mm) {
  if (pixel_mm >= 1e-12 && pixel_mm <= 1e12) return;
  std::ostringstream seen;
  seen << pixel_mm;
  throw Error(ErrorCode::usage, "pixel_mm", seen.str(), "1e-12..1e12 mm");
}

}  // namespace dermis
