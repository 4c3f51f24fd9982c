// Profiles and their separable stand-ins on the pixels of a square that repeats.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/taps.hpp"

namespace dermis::bench {

/// Pixels along the side of the square that everything is measured in.
inline constexpr int side_px = 512;
inline constexpr int half_px = side_px / 2;

/// scale f(x) f(y) for an even f, given at 0..half_px.
struct Product {
  double scale = 1;
  Eigen::VectorXd f;
};

/// A sum of products per channel: the kernels that separable passes can have.
using Products = std::array<std::vector<Product>, 3>;

/// The light of an even kernel on the pixels 0..half_px by 0..half_px; per channel.
using Light = std::array<Eigen::MatrixXd, 3>;

/// A profile on pixels of one size.
struct Sample {
  std::string name;
  Profile profile;
  double pixel_mm = 0;
  Light exact;     ///< unit sum over the square; the outermost row takes all that lies beyond it
  Light spectrum;  ///< cosine sums of `exact` at the frequencies 0..half_px by 0..half_px
};

/// Samples a profile on pixels of such a size that `width_mm` are `width_px` pixels.
Sample make_sample(const std::string& name, const Profile& profile, double width_mm, double width_px);

/// The standard deviation along an axis of the channel that spreads furthest.
double axis_deviation_mm(const Profile& profile, int channel);

/// The cosine sums at the frequencies 0..half_px of an even row.
Eigen::VectorXd response_of(const Eigen::VectorXd& row);
Eigen::MatrixXd spectrum_of(const std::vector<Product>& products);
Eigen::MatrixXd light_of(const std::vector<Product>& products);

/// The sum over a whole even row.
double sum_of(const Eigen::VectorXd& row);
double sum_of(const std::vector<Product>& products);

/// The kernel summed over y: its effect on light that changes along x only.
Eigen::VectorXd row_sums(const std::vector<Product>& products);
Eigen::VectorXd row_sums(const Eigen::MatrixXd& light);

/// The light at the pixels -half_px..half_px - 1 after a kernel with these row sums has spread a step of height 1
/// between the pixels -1 and 0.
Eigen::VectorXd step_response(const Eigen::VectorXd& row_sums);

/// The profile summed along lines, on every pixel (Jimenez et al. 2015, eq. 5).
Products pre_integrated(const Profile& profile, double pixel_mm);
/// The taps of a design, scattered to pixels.
Products products_of(const TapSet& taps);
/// A model of the library on every pixel.
Products dense_model(const Sample& sample, Model model, int rank, double guide = 2);

}  // namespace dermis::bench
