/// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace dermis::oracle {

struct QuadraturePoint {
  double position;  ///< in -1/2..1/2
  double weight;    ///< they sum to 1
};

/// The rule that integrates polynomials of degree 2 count - 1 exactly over -1/2..1/2.
std::vector<QuadraturePoint> gauss_legendre(int count);

}  // namespace dermis::oracle
