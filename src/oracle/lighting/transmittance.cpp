#include <cmath>
#include <numbers>

#include "dermis/oracle/lighting.hpp"
#include "oracle/math/adaptive_integral.hpp"

namespace dermis::oracle {

double transmittance(const std::function<double(double)>& radial, double thickness_mm, double reach_mm) {
  if (thickness_mm >= reach_mm) return 0;
  // With r = reach x^4 the innermost millionth of the reach has a share of x that quadrature resolves.
  const auto ring = [&](double x) {
    const double r = reach_mm * std::pow(x, 4);
    const double distance = std::hypot(r, thickness_mm);
    if (x == 0 || distance > reach_mm) return 0.0;
    return 2 * std::numbers::pi * r * radial(distance) * 4 * reach_mm * std::pow(x, 3);
  };
  return adaptive_integral(ring, 0, 1, 64, 1e-8);
}

}  // namespace dermis::oracle
