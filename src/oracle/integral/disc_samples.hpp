/// The samples of the disc method.
#pragma once

#include <vector>

#include "dermis/oracle/reference.hpp"

namespace dermis::oracle {

/// A sample in the plane of the disc, for a profile as wide as that of the material.
struct DiscSample {
  double x_mm, y_mm;
  double spacing_mm;  ///< the root of the area that it stands for
};

/// Samples that share the light beyond some distance.
struct DiscSet {
  double inner_mm;  ///< No sample lies nearer, nor does half of what the first one stands for.
  std::vector<DiscSample> samples;
};

inline constexpr int disc_starts = 16;

/// Returns the sets of a material that begin at each 16th of its light; none if `count`, the samples of a set, is 0.
std::vector<DiscSet> make_disc_sets(const Material& material, int count);

}  // namespace dermis::oracle
