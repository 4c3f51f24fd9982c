/// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace dermis::oracle {

struct QuadraturePoint {
  double position;  ///< in -1/2..1/2
  double weight;    ///< the weights of a rule sum to 1
};

/// Returns the rule of `count` points that integrates polynomials of degree 2 count - 1 exactly over -1/2..1/2.
std::vector<QuadraturePoint> gauss_legendre(int count);

}  // namespace dermis::oracle
