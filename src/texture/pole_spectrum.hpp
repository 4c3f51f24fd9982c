// Even functions of one variable as sums of exponentials.
#pragma once

#include <Eigen/Core>

#include "dermis/texture.hpp"

namespace dermis {

/// The spectrum of two pole pairs at squared frequencies w: the sum over pairs of
///
///     (share + slope w) / (w^2 + 2 balance w + 1),   w = omega^2 / squared_rate.
///
/// The poles are a complex pair for a balance in -1..1, and real beyond: a smooth way from one to the other.
class PoleSpectrum {
 public:
  /// Logarithm of squared_rate, that of balance + 0.7, slope and share of each pair, but for the share of the last,
  /// which makes up what the others lack of the integral.
  static constexpr int unknowns = 4 * Recursion::pairs - 1;

  explicit PoleSpectrum(double integral) : integral_(integral) {}

  Eigen::VectorXd values(const Eigen::VectorXd& parameters, const Eigen::VectorXd& squared_omega) const;
  Recursion::Function function(const Eigen::VectorXd& parameters) const;

  /// The parameters that make the weighted distance to `truth` least, of several starts. `scale` is a frequency that
  /// the function belongs to.
  Eigen::VectorXd fit(const Eigen::VectorXd& squared_omega, const Eigen::VectorXd& truth, const Eigen::VectorXd& weight,
                      double scale) const;

 private:
  struct Pair {
    double squared_rate, balance, slope, share;
  };
  Pair pair(const Eigen::VectorXd& parameters, int number) const;

  double integral_;
};

}  // namespace dermis
