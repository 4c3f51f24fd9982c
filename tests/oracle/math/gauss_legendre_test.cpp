#include "oracle/math/gauss_legendre.hpp"

#include <cmath>

#include "support/catch.hpp"

namespace dermis::oracle {

TEST_CASE("n points integrate polynomials of degree 2n - 1", "[gauss_legendre]") {
  for (const int count : {1, 2, 3, 4, 8, 24}) {
    const auto points = gauss_legendre(count);
    REQUIRE(points.size() == static_cast<std::size_t>(count));
    const auto integral = [&](int power) {
      double sum = 0;
      for (const QuadraturePoint& point : points) sum += point.weight * std::pow(point.position + 0.5, power);
      return sum;
    };
    for (int power = 0; power < 2 * count; ++power) CHECK(integral(power) == Approx(1.0 / (power + 1)).epsilon(1e-13));
    if (count < 8) CHECK(integral(2 * count) != Approx(1.0 / (2 * count + 1)).epsilon(1e-9));
  }
}

}  // namespace dermis::oracle
