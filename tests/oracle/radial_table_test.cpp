#include "oracle/radial_table.hpp"

#include "catch.hpp"

namespace dermis::oracle {

namespace {

/// Nodes at r^2 = 1/2, 3/4, 1, 3/2, 2; one value per channel.
RadialTable small_table() { return {-1, 1, {{8, 80, 1}, {4, 40, 1}, {2, 20, 1}, {1, 10, 1}, {0, 5, 1}}}; }

double at(double r2, int channel = 0) { return look_up(small_table(), channel, exact(r2)).value; }

}  // namespace

TEST_CASE("a radial table is linear between its nodes", "[radial_table]") {
  CHECK(at(0.5) == 8);
  CHECK(at(0.625) == 6);
  CHECK(at(0.75) == 4);
  CHECK(at(1) == 2);
  CHECK(at(1.125) == 1.75);
  CHECK(at(1.75) == 0.5);
  CHECK(at(1.125, 1) == 17.5);
}

TEST_CASE("a radial table is constant beyond its ends", "[radial_table]") {
  CHECK(at(0) == 8);
  CHECK(at(1e-40) == 8);
  CHECK(at(0.49999) == 8);
  CHECK(at(2) == 0);
  CHECK(at(1e30) == 0);
  CHECK(at(2, 1) == 5);
  CHECK(at(1e30, 1) == 5);
  const RadialTable one{0, 3, {{7, 7, 7}}};
  CHECK(look_up(one, 0, exact(0.1)).value == 7);
  CHECK(look_up(one, 0, exact(10)).value == 7);
}

TEST_CASE("an uncertain distance makes the value as uncertain as the curve is steep", "[radial_table]") {
  const auto error = [](double r2, double by) { return look_up(small_table(), 0, {r2, by}).error; };
  CHECK(error(1.25, 0.125) == Approx(0.25).epsilon(1e-5));  // slope -2
  CHECK(error(0.75, 0.125) == Approx(2).epsilon(1e-5));     // the steeper side of a kink, slope -16
  CHECK(error(1.875, 1) == Approx(3 - 0.25).epsilon(1e-5));
  CHECK(error(5, 1) < 1e-6);
  CHECK(error(1.25, 0) < 1e-6);
  CHECK(error(1.25, 0) > 1e-8);
}

}  // namespace dermis::oracle
