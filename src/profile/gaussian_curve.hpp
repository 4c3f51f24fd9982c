// One channel of a sum of Gaussians.
#pragma once

#include <vector>

#include "profile/radial_curve.hpp"

namespace dermis {

/// The sum over terms of weight exp(-r^2 / 2v) / (2 pi v).
class GaussianCurve final : public RadialCurve {
 public:
  struct Term {
    double weight;    ///< > 0; all sum to 1
    double variance;  ///< mm^2
  };

  explicit GaussianCurve(std::vector<Term> terms);

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double marginal(double x) const override;
  double edge_tail(double x) const override;
  double spectrum(double omega) const override;
  double strip(double from, double to) const override;
  double rectangle(double x0, double x1, double y0, double y1) const override;
  double scale() const override { return widest_; }
  double reach() const override { return 40 * widest_; }

 private:
  std::vector<double> numbers() const override;

  std::vector<Term> terms_;
  double widest_ = 0;  ///< standard deviation, mm
};

}  // namespace dermis
