// The singular value decomposition of a profile on pixels: Jimenez et al. 2015, section 3.
#pragma once

#include "paper/lattice.hpp"

namespace dermis::bench {

struct Svd {
  std::array<Eigen::VectorXd, 3> values;  ///< per channel, falling
  Products products;                      ///< all, largest first

  /// The first `rank` terms, as they are.
  Products truncated(int rank) const;
  /// The first `rank` terms, each channel scaled so that it keeps all light.
  Products renormalised(int rank) const;
};

Svd svd_of(const Sample& sample);

}  // namespace dermis::bench
