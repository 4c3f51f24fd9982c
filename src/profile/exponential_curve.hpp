// One channel of a sum of exponentials over r.
#pragma once

#include <vector>

#include "profile/smooth_curve.hpp"

namespace dermis {

/// The sum over terms of weight e^(-r/d) / (2 pi d r).
class ExponentialCurve final : public SmoothCurve {
 public:
  struct Term {
    double weight;  ///< > 0; all sum to 1
    double d;       ///< mm
  };

  explicit ExponentialCurve(std::vector<Term> terms);

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double spectrum(double omega) const override;
  double scale() const override { return scale_; }
  double reach() const override { return 740 * widest_; }

 private:
  std::vector<double> numbers() const override;

  std::vector<Term> terms_;
  double scale_ = 0;
  double widest_ = 0;
};

}  // namespace dermis
