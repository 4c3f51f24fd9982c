/// How random walks go from a hidden sample to a pixel.
#pragma once

#include <array>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/math/vec3.hpp"

namespace dermis::oracle {

class WalkCrossing {
 public:
  /// Walks through the medium of the material, to slabs as thick as `reach_mm`.
  WalkCrossing(const Material& material, double reach_mm);

  /// What the light of a pair of points that the profile tells is multiplied with, and what curvature adds to it.
  struct Gain {
    double slab;
    double bend;
  };

  /// `way` leads from the pixel to the sample; `r_mm` is its length, with the size of the sample.
  Gain gain(int channel, const Vec3& normal, const Vec3& sample_normal, const Vec3& way, double r_mm) const;

 private:
  double slab_gain(int channel, double thickness_mm) const;

  double step_mm_;
  std::array<double, 3> bend_mm_{};
  std::array<double, 3> mfp_mm_{};
  std::array<std::vector<double>, 3> gains_;  ///< of slabs of 0, 1, 2, ... steps
};

}  // namespace dermis::oracle
