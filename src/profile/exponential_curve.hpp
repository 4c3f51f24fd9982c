// One channel of a sum of exponentials over r.
#pragma once

#include <vector>

#include "profile/radial_curve.hpp"

namespace dermis {

/// The sum over terms of weight e^(-r/d) / (2 pi d r). Sums along lines are those of one exponential, term by term: the
/// logarithm of a sum of many has singularities that are too close for an `EdgeTable`.
class ExponentialCurve final : public RadialCurve {
 public:
  struct Term {
    double weight;  ///< > 0; all sum to 1
    double d;       ///< mm
  };

  explicit ExponentialCurve(std::vector<Term> terms);

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double marginal(double x) const override;
  double edge_tail(double x) const override;
  double spectrum(double omega) const override;
  double scale() const override { return scale_; }
  double reach() const override;

 private:
  std::vector<double> numbers() const override;

  std::vector<Term> terms_;
  double scale_ = 0;
  double widest_ = 0;
};

}  // namespace dermis
