// One channel of Burley's normalized diffusion.
#pragma once

#include "profile/smooth_curve.hpp"

namespace dermis {

/// R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r) (Golubev 2018, with s = 1/d).
class BurleyCurve final : public SmoothCurve {
 public:
  explicit BurleyCurve(double d) : d_(d) {}

  double radial(double r) const override;
  double disc(double r) const override;
  double disc_tail(double r) const override;
  double spectrum(double omega) const override;
  double radius(double share) const override;
  double scale() const override { return d_; }
  double reach() const override { return 3 * 740 * d_; }

 private:
  std::vector<double> numbers() const override { return {d_}; }

  double d_;
};

}  // namespace dermis
