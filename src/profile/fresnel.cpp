#include "profile/fresnel.hpp"

#include <cmath>

#include "profile/quadrature.hpp"

namespace dermis {

FresnelMoments fresnel_moments(double eta) {
  // All is turned back below the critical cosine. Above it, over the cosine w outside, m dm = w dw / eta^2 and the
  // integrand is smooth.
  const double critical = std::sqrt(1 - 1 / (eta * eta));
  const auto over_outside = [eta](int power_of_inside) {
    return panel_integral<64>(0, 1, [=](double w) {
      const double m = std::sqrt(1 - (1 - w * w) / (eta * eta));
      const double parallel = (m - eta * w) / (m + eta * w);
      const double perpendicular = (eta * m - w) / (eta * m + w);
      const double reflected = (parallel * parallel + perpendicular * perpendicular) / 2;
      return reflected * std::pow(m, power_of_inside) * w / (eta * eta);
    });
  };
  return {std::pow(critical, 2) / 2 + over_outside(0), std::pow(critical, 3) / 3 + over_outside(1)};
}

double diffuse_fresnel_fit(double eta) { return -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta; }

}  // namespace dermis
