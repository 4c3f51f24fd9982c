/// Measures of how far two images are apart.
#pragma once

#include <limits>

#include "dermis/oracle/picture.hpp"

namespace dermis::oracle {

/// The difference of image `a` from the reference `b`, over all channels. Values that are not finite in both and equal
/// in kind count as equal; one that is not finite in only one makes every figure infinite (psnr_db minus infinity).
struct Difference {
  double relative_l2 = 0;  ///< |a - b| / |b|; 0 if both are zero
  double rmse = 0;
  double psnr_db = std::numeric_limits<double>::infinity();  ///< against the largest |b|
  double max = 0;                                            ///< largest |a - b|
  int max_x = 0, max_y = 0, max_channel = 0;                 ///< where it occurs
  double max_a = 0, max_b = 0;                               ///< the values of both there
};

/// Compares all pixels. Throws Error(usage) if the sizes differ.
Difference compare(const Picture& a, const Picture& b);

/// Compares the pixels where `where` (1 channel) is not zero. Throws Error(usage) if the sizes differ.
Difference compare(const Picture& a, const Picture& b, const Picture& where);

}  // namespace dermis::oracle
