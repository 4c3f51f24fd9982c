// Pictures to spread light on: the statistics of natural images, small dots, straight edges at any angle.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "inputs/spectrum.hpp"
#include "paper/lattice.hpp"

namespace dermis::bench {

/// The mean power of some pictures at the frequencies 0..half_px by 0..half_px, mirror images summed: all that the
/// error of an even kernel depends on.
class Pictures {
 public:
  /// Makes natural pictures (inputs/natural_picture.hpp) of the seeds from `seed` on.
  static Pictures natural(int count, std::uint32_t seed);
  /// Makes one bright disc on black.
  static Pictures dot(double radius_px);

  /// Relative L2 distance of what the products make of the pictures from what the profile does, all channels together.
  double rel_l2(const Products& products, const Sample& sample) const;
  /// Relative L2 distance from what other products make of the pictures.
  double rel_l2(const Products& products, const Products& truth) const;

 private:
  Pictures();
  void add(const std::vector<double>& picture);
  double rel_l2(const Products& products, const Light& truth) const;

  Eigen::MatrixXd power_;
};

/// Light on one side of a straight line through the middle, 0 on the other; pixels on the line have their share.
class Edge {
 public:
  explicit Edge(double angle_degrees);

  /// The largest difference, of 1, between what the products and what the profile make of the edge, away from the
  /// border of the square.
  double max_error(const Products& products, const Sample& sample) const;

 private:
  Spectrum spectrum_;
};

}  // namespace dermis::bench
