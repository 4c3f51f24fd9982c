// Passes of several terms over a few pixels, computed by hand.
#include <array>
#include <cstddef>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

namespace {

/// The light of 3 x 3 pixels is u(x) v(y) in red, so that each term's light is a product too.
constexpr std::array<double, 3> u{1, 10, 100};
constexpr std::array<double, 3> v{2, 3, 7};

MadeFrame nine_pixels() {
  MadeFrame made(3, 3, one_px_per_mm, 0);
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 3; ++x) made.light[3 * (3 * y + x)] = static_cast<float>(u[x] * v[y]);
  }
  return made;
}

/// Returns the frame as it is, whose blocks are flat, and with curved blocks, whose weights are the same on a plane.
std::vector<MadeFrame> flat_and_curved(const MadeFrame& made) { return {made, never_flat(made)}; }

/// Returns the mean with the weight `center` and, for both neighbours, `side`.
double mean(const std::array<double, 3>& values, std::size_t i, double center, double side) {
  double weights = center;
  double sum = center * values[i];
  for (const std::size_t j : {i - 1, i + 1}) {
    if (j > 2) continue;
    weights += side;
    sum += side * values[j];
  }
  return sum / weights;
}

double difference(const std::array<double, 3>& values, std::size_t i, double total, double side) {
  double sum = total * values[i];
  for (const std::size_t j : {i - 1, i + 1}) {
    if (j < 3) sum += side * (values[j] - values[i]);
  }
  return sum;
}

}  // namespace

TEST_CASE("two normalised terms by hand", "[terms]") {
  Material material = tiny_material();
  add_term(material.taps, {}, tiny_rows(0.75, 0.125));
  share_out(material.taps, 0.25);
  for (const MadeFrame& made : flat_and_curved(nine_pixels())) {
    const Reference reference = run(made, material);
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t x = 0; x < 3; ++x) {
        const double first = mean(u, x, 0.5, 0.25) * mean(v, y, 0.5, 0.25);
        const double second = mean(u, x, 0.75, 0.125) * mean(v, y, 0.75, 0.125);
        CHECK(reference.scattered(static_cast<int>(x), static_cast<int>(y)) ==
              Approx(0.75 * first + 0.25 * second).epsilon(1e-14));
      }
    }
  }
}

TEST_CASE("a difference term by hand: taps that are missing count as the pixel", "[terms]") {
  for (const double sum : {0.0, 1.0, -0.5}) {
    Material material = tiny_material();
    add_term(material.taps, difference_term(sum), tiny_rows(1, 0.125));
    material.taps.terms[1].scale = grey(0.5);
    for (const MadeFrame& made : flat_and_curved(nine_pixels())) {
      const Reference reference = run(made, material);
      for (std::size_t y = 0; y < 3; ++y) {
        for (std::size_t x = 0; x < 3; ++x) {
          INFO("sum " << sum << " at " << x << ", " << y);
          const double first = mean(u, x, 0.5, 0.25) * mean(v, y, 0.5, 0.25);
          const double second = difference(u, x, sum, 0.125) * difference(v, y, sum, 0.125);
          CHECK(reference.scattered(static_cast<int>(x), static_cast<int>(y)) ==
                Approx(first + 0.5 * second).epsilon(1e-14));
        }
      }
    }
  }
}

TEST_CASE("a difference term is limited by the sum of the first term's weights", "[terms]") {
  // On a curved block the first term's weights sum to 1/2 + 2 * 3/4 = 2 in the middle, 5/4 beside it.
  Material material = tiny_material();
  set_levels(material.taps, {made_level(1, {1})}, tiny_rows(0.5, 0.75));
  add_term(material.taps, difference_term(1), tiny_rows(1, 0.125));
  const Reference reference = run(never_flat(three_pixels()), material);
  CHECK(reference.scattered(1, 0) ==
        Approx((0.5 * 10 + 0.75 * 101) / 2 + 10 + 0.125 / 2 * (1 + 100 - 2 * 10)).epsilon(1e-14));
  CHECK(reference.scattered(0, 0) == Approx((0.5 * 1 + 0.75 * 10) / 1.25 + 1 + 0.125 / 1.25 * (10 - 1)).epsilon(1e-14));
}

TEST_CASE("the centre of a difference term counts nothing", "[terms]") {
  Material material = tiny_material();
  add_term(material.taps, difference_term(0), tiny_rows(1, 0.125));
  const MadeFrame made = never_flat(nine_pixels());
  const Reference before = run(made, material);
  material.taps.levels[0].weights[1] = linear(0.5);
  const Reference after = run(made, material);
  CHECK(after.scattered.values == before.scattered.values);
  CHECK(after.scattered_bound.values == before.scattered_bound.values);
  material.taps.levels[0].weights[0] = linear(0.6);
  CHECK(run(made, material).scattered.values != before.scattered.values);
}

TEST_CASE("without taps a term is its sum at one point", "[terms]") {
  for (const bool across : {true, false}) {
    // One pass has taps. The other one, at half a pixel to the mm, is too narrow for a radius of 0.9 mm.
    MadeFrame made = three_pixels(!across);
    made.camera = across ? Camera::orthographic(1, 0.5) : Camera::orthographic(0.5, 1);
    Material material = tiny_material();
    material.taps.radius_mm = 0.9;
    add_term(material.taps, difference_term(2), tiny_rows(1, 0.125));
    material.taps.terms[1].scale = grey(0.5);
    for (const MadeFrame& either : flat_and_curved(made)) {
      const Reference reference = run(either, material);
      for (std::size_t i = 0; i < 3; ++i) {
        const double second = 2 * difference(u, i, 2, 0.125);
        CHECK(reference.scattered.values[3 * i] == Approx(mean(u, i, 0.5, 0.25) + 0.5 * second).epsilon(1e-14));
      }
    }
  }
}

TEST_CASE("a pixel that is left alone gives its light to every term and keeps it", "[terms]") {
  // The middle column is only read. It shows the vertical pass its light, times the sum for a difference.
  MadeFrame made = nine_pixels();
  made.mask.assign(9, 1);
  for (const std::size_t y : {0U, 1U, 2U}) made.mask[3 * y + 1] = 0.01F;
  made.mask[4] = 1;
  Material material = tiny_material();
  add_term(material.taps, difference_term(2), tiny_rows(1, 0.125));
  const Reference reference = run(made, material);
  CHECK(reference.touched.values == std::vector<double>{1, 0, 1, 1, 1, 1, 1, 0, 1});
  CHECK(reference.scattered(1, 0) == u[1] * v[0]);
  CHECK(reference.scattered_bound(1, 0) == 0);
  // The middle pixel scatters horizontally, between two that do not.
  const double first = 0.5 * mean(u, 1, 0.5, 0.25) * v[1] + 0.25 * u[1] * (v[0] + v[2]);
  const double own = difference(u, 1, 2, 0.125) * v[1];
  const double second = 2 * own + 0.125 * (2 * u[1] * v[0] - own) + 0.125 * (2 * u[1] * v[2] - own);
  CHECK(reference.scattered(1, 1) == Approx(first + second).epsilon(1e-14));
}

TEST_CASE("two pixels of one term beside two of two", "[terms]") {
  MadeFrame row(4, 1, one_px_per_mm, 0);
  row.material = {1, 1, 2, 2};
  for (std::size_t i = 0; i < 4; ++i) row.light[3 * i] = static_cast<float>(1 + i * i);  // 1, 2, 5, 10
  std::vector tiny{tiny_material(1), tiny_material(2)};
  add_term(tiny[1].taps, difference_term(1), tiny_rows(1, 0.125));
  const Reference by_hand = separable(row.frame(), tiny, {});
  CHECK(by_hand.scattered(0, 0) == Approx((0.5 * 1 + 0.25 * 2) / 0.75));
  CHECK(by_hand.scattered(1, 0) == Approx((0.5 * 2 + 0.25 * 1) / 0.75));
  CHECK(by_hand.scattered(2, 0) == Approx((0.5 * 5 + 0.25 * 10) / 0.75 + 5 + 0.125 * 5));
  CHECK(by_hand.scattered(3, 0) == Approx((0.5 * 10 + 0.25 * 5) / 0.75 + 10 - 0.125 * 5));
}

}  // namespace dermis::oracle
