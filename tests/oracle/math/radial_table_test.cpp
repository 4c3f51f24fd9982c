#include "oracle/math/radial_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "oracle/support/made_table.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// Returns a table whose octaves from r^4 = 1/2 are 8 - 6 t + 2 t^2, 4 - 2 t, 2 - 2 t + t^2, 1 - t, then 0 up to r^4 =
/// 2^31. Green is ten times as much.
RadialTable small_table() {
  RadialTable table = table_of_lines(-1, {8, 4, 2, 1, 0});
  set_parabola(table, 0, 8, -6, 2);
  set_parabola(table, 2, 2, -2, 1);
  for (auto& coefficient : table.coefficients[1]) {
    for (float& value : coefficient) value *= 10;
  }
  return table;
}

double at(double r4, int channel = 0) { return look_up(small_table(), channel, exact(r4)).value; }

/// Returns a table of random parabolas that meet.
RadialTable random_table(Random& random) {
  RadialTable table;
  table.first_exponent = random.integer(-12, 4);
  double from = random.uniform(-1, 1);
  for (int octave = 0; octave < RadialTable::octaves; ++octave) {
    const double to = random.uniform(-1, 1);
    const double bend = random.uniform(-2, 2);
    set_parabola(table, octave, from, to - from - bend, bend);
    from = to;
  }
  return table;
}

/// Reads a table as a device does.
float float_look_up(const RadialTable& table, float r4, bool fused, bool just_before_end) {
  const auto bits = static_cast<int>(std::bit_cast<std::uint32_t>(r4));
  const int from_first = std::max(bits - ((127 + table.first_exponent) << 23), 0);
  const bool beyond = from_first >> 23 >= RadialTable::octaves;
  const auto octave = static_cast<std::size_t>(beyond ? RadialTable::octaves - 1 : from_first >> 23);
  const float t = beyond ? (just_before_end ? 1 - 0x1p-23F : 1) : static_cast<float>(from_first & 0x7FFFFF) * 0x1p-23F;
  const auto& [a, b, bend] = table.coefficients[0];
  if (fused) return std::fma(t, std::fma(t, bend[octave], b[octave]), a[octave]);
  const float inner = t * bend[octave] + b[octave];
  return t * inner + a[octave];
}

}  // namespace

TEST_CASE("a radial table is a parabola in each octave", "[radial_table]") {
  CHECK(at(0.5) == 8);
  CHECK(at(0.625) == 8 - 6 * 0.25 + 2 * 0.0625);
  CHECK(at(0.75) == 8 - 6 * 0.5 + 2 * 0.25);
  CHECK(at(1) == 4);
  CHECK(at(1.5) == 3);
  CHECK(at(3) == 2 - 2 * 0.5 + 0.25);
  CHECK(at(7) == 0.25);
  CHECK(at(3, 1) == 12.5);
}

TEST_CASE("a radial table is constant beyond its ends", "[radial_table]") {
  CHECK(at(0) == 8);
  CHECK(at(1e-40) == 8);
  CHECK(at(0.49999) == 8);
  for (const double r4 : {8.0, 9.0, 0x1p31 - 1, 0x1p31, 1e30}) CHECK(at(r4) == 0);
  RadialTable table = small_table();
  set_parabola(table, RadialTable::octaves - 1, 0, 3, -1);
  CHECK(look_up(table, 2, exact(3 * 0x1p29)).value == 1.25);
  for (const double r4 : {0x1p31, 1e30}) {
    const Bounded end = look_up(table, 0, exact(r4));
    CHECK(end.value == 2);
    CHECK(end.error < 2e-6);
  }
}

TEST_CASE("an uncertain distance makes the value as uncertain as the curve is steep", "[radial_table]") {
  const auto error = [](double r4, double by) { return look_up(small_table(), 0, {r4, by}).error; };
  CHECK(error(1.5, 0.25) == Approx(0.5).epsilon(1e-5));  // slope -2 per octave of length 1
  CHECK(error(0.5, 0.25) == Approx(2.5).epsilon(1e-5));  // constant to the left
  CHECK(error(1, 0.5) == Approx(4).epsilon(1e-5));       // the whole octave to the left
  CHECK(error(7.5, 1) == Approx(0.25).epsilon(1e-5));    // 3/8 - 1/8 on the steeper side of 8
  CHECK(error(100, 1) < 1e-30);
  CHECK(error(1.5, 0) < 1e-6);
  CHECK(error(1.5, 0) > 1e-8);
  CHECK(look_up(small_table(), 0, {1, 1e9}).error == Approx(4).epsilon(1e-5));
}

TEST_CASE("a parabola may be extreme between the ends of the range", "[radial_table]") {
  RadialTable table;
  set_parabola(table, 0, 0, 4, -4);  // 1 at r^4 = 1.5, 0 at 1 and 2
  CHECK(look_up(table, 0, {1.5, 0.5}).error == Approx(1).epsilon(1e-5));
  CHECK(look_up(table, 0, {1.25, 0.375}).error == Approx(0.75).epsilon(1e-5));  // from 3/4 down to 0
  CHECK(look_up(table, 0, {1.3125, 0.25}).error == Approx(0.859375 - 0.234375).epsilon(1e-5));
  CHECK(look_up(table, 0, {1.9375, 0.5}).error == Approx(1 - 0.234375).epsilon(1e-5));  // the vertex
}

TEST_CASE("where octaves meet but for rounding, the bound covers both", "[radial_table]") {
  RadialTable table;
  set_parabola(table, 0, 1, 0, 0);
  set_parabola(table, 1, 1.0625, 0, 0);
  CHECK(look_up(table, 0, exact(2)).error < 1e-6);
  CHECK(look_up(table, 0, {2, 1e-6}).error == Approx(0.0625).epsilon(1e-5));
  CHECK(look_up(table, 0, {2 - 1e-7, 1e-6}).error == Approx(0.0625).epsilon(1e-5));
}

TEST_CASE("no float32 evaluation leaves the bound of a table", "[radial_table]") {
  Random random(31);
  double worst = 0;
  for (int round = 0; round < 200; ++round) {
    const RadialTable table = random_table(random);
    for (int i = 0; i < 200; ++i) {
      const bool at_boundary = i % 5 == 0;
      const double exponent = table.first_exponent + random.uniform(-1, RadialTable::octaves + 1);
      const double middle = std::exp2(at_boundary ? std::round(exponent) : exponent);
      const double by = random.coin() ? 0 : middle * std::exp(random.uniform(-16, 0));
      const auto r4 = static_cast<float>(middle + (by == 0 ? 0 : random.uniform(-1, 1) * by));
      const Bounded known{by == 0 ? static_cast<double>(r4) : middle, by + 0x1p-24 * static_cast<double>(r4)};
      const Bounded bounded = look_up(table, 0, by == 0 ? exact(known.value) : known);
      const double value = static_cast<double>(float_look_up(table, r4, random.coin(), random.coin()));
      const double error = std::abs(value - bounded.value);
      if (!(error <= bounded.error)) FAIL_CHECK("r4 " << r4 << " is " << error << " off, bound " << bounded.error);
      worst = std::max(worst, error / bounded.error);
    }
  }
  INFO("largest share of a bound " << worst);
  CHECK(worst > 0.5);
}

}  // namespace dermis::oracle
