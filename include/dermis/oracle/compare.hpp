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

/// How far an image is from what path-traced ones show, which have noise.
struct TruthError {
  double relative_l2 = 0;  ///< without the noise if there are two; 0 if there is less than the noise leaves to see
  double noise = 0;        ///< of one of the two, relative L2; 0 if both are the same
};

/// relative_l2 = sqrt(sum (a - t)(a - u) / sum t u) over the pixels where `where` (1 channel) is not zero, with two
/// truths t and u of independent noise, which has the mean 0 in both sums. With the same one twice it is that of
/// Difference, noise and all. A value that is not finite makes it infinite. Throws Error(usage) if the sizes differ.
TruthError compare_with_truth(const Picture& a, const Picture& t, const Picture& u, const Picture& where);

}  // namespace dermis::oracle
