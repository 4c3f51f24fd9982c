#include "dermis/oracle/compare.hpp"

#include <cmath>
#include <limits>

#include "dermis/error.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Picture row(std::vector<double> values) {
  Picture picture(static_cast<int>(values.size()), 1, 1);
  picture.values = std::move(values);
  return picture;
}

}  // namespace

TEST_CASE("compare gives the textbook figures", "[compare]") {
  const Difference d = compare(row({3, 4, 1, 1}), row({3, 4, 3, 4}));
  CHECK(d.relative_l2 == Approx(std::sqrt(13.0 / 50)).epsilon(1e-14));
  CHECK(d.rmse == Approx(std::sqrt(13.0 / 4)).epsilon(1e-14));
  CHECK(d.psnr_db == Approx(20 * std::log10(4 / std::sqrt(13.0 / 4))).epsilon(1e-14));
  CHECK(d.max == 3);
  CHECK(d.max_x == 3);
  CHECK(d.max_a == 1);
  CHECK(d.max_b == 4);
}

TEST_CASE("an error against two noisy truths is without their noise, against one it is with it", "[compare]") {
  Random random(90);
  constexpr int pixels = 20000;
  Picture truth(pixels, 1, 3);
  Picture a(pixels, 1, 3);
  Picture t(pixels, 1, 3);
  Picture u(pixels, 1, 3);
  Picture where(pixels, 1, 1, 1);
  const double off = random.uniform(0.05, 0.2);
  const double noise = random.uniform(0.2, 0.5);
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    truth.values[i] = random.uniform(0.5, 1.5);
    a.values[i] = truth.values[i] + (random.coin() ? off : -off);
    t.values[i] = truth.values[i] + noise * random.uniform(-1, 1);
    u.values[i] = truth.values[i] + noise * random.uniform(-1, 1);
  }
  // Where nobody looks there may be anything.
  where.values[7] = 0;
  for (const std::size_t i : {21U, 22U, 23U}) a.values[i] = not_a_number;
  const double size2 = 1 + 1.0 / 12;  // mean square of uniform values in 0.5..1.5
  const double noise2 = noise * noise / 3;
  // A sum over n = 60000 values of the product of two errors of variance noise2 (and of off^2 with one of them) has a
  // standard deviation of sqrt(n (noise2^2 + 2 off^2 noise2)). Six of them: 2e-9 of all runs are beyond.
  const double doubt = 6 * std::sqrt((noise2 * noise2 + 2 * off * off * noise2) / 60000) / size2;
  const double wanted = off * off / size2;
  const TruthError two = compare_with_truth(a, t, u, where);
  CHECK(std::abs(two.relative_l2 * two.relative_l2 - wanted) < doubt + 0.02 * wanted);
  CHECK(two.noise * two.noise == Approx(noise2 / size2).epsilon(0.05));
  const TruthError one = compare_with_truth(a, t, t, where);
  CHECK(one.relative_l2 == Approx(compare(a, t, where).relative_l2).epsilon(1e-12));
  CHECK(one.relative_l2 * one.relative_l2 > wanted + noise2 / size2 / 2);
  CHECK(one.noise == 0);
  CHECK(compare_with_truth(t, t, u, where).relative_l2 == 0);
  CHECK(compare_with_truth(a, t, u, Picture(pixels, 1, 1, 1)).relative_l2 == infinity);
}

TEST_CASE("compare finds the place of the largest difference", "[compare]") {
  Picture a(5, 4, 3, 2);
  const Picture b(5, 4, 3, 2);
  a(3, 2, 1) = -7;
  a(4, 3, 2) = 3;
  const Difference d = compare(a, b);
  CHECK((d.max_x == 3 && d.max_y == 2 && d.max_channel == 1));
  CHECK(d.max == 9);
  CHECK(d.max_a == -7);
}

TEST_CASE("compare of equal pictures is perfect", "[compare]") {
  for (const double value : {0.0, 2.5, not_a_number, infinity, -infinity}) {
    const Difference d = compare(row({value, value}), row({value, value}));
    CHECK(d.relative_l2 == 0);
    CHECK(d.rmse == 0);
    CHECK(d.max == 0);
    CHECK(d.psnr_db == infinity);
  }
}

TEST_CASE("a value that is not finite on one side only spoils every figure", "[compare]") {
  const auto spoilt = [](double a, double b) {
    const Difference d = compare(row({1, a, 2}), row({1, b, 2}));
    CHECK(d.relative_l2 == infinity);
    CHECK(d.rmse == infinity);
    CHECK(d.max == infinity);
    CHECK(d.psnr_db == -infinity);
    CHECK(d.max_x == 1);
  };
  spoilt(not_a_number, 1);
  spoilt(1, not_a_number);
  spoilt(infinity, 1);
  spoilt(infinity, -infinity);
  spoilt(not_a_number, infinity);
}

TEST_CASE("values that are not finite on both sides do not hide other differences", "[compare]") {
  const Difference d = compare(row({not_a_number, 1, infinity}), row({not_a_number, 2, infinity}));
  CHECK(d.max == 1);
  CHECK(d.relative_l2 == Approx(0.5));
  CHECK(d.rmse == Approx(std::sqrt(1.0 / 3)));
}

TEST_CASE("any difference from black is infinite relative to it", "[compare]") {
  const Difference d = compare(row({0, 1}), row({0, 0}));
  CHECK(d.relative_l2 == infinity);
  CHECK(d.psnr_db == -infinity);
  CHECK(d.rmse == Approx(std::sqrt(0.5)));
}

TEST_CASE("compare looks only where it is told to", "[compare]") {
  const Picture a = row({1, 5, not_a_number});
  const Picture b = row({2, 9, 0});
  CHECK(compare(a, b, row({1, 0, 0})).max == 1);
  CHECK(compare(a, b, row({0, 1, 0})).max == 4);
  CHECK(compare(a, b, row({0, 0, 1})).max == infinity);
  CHECK(compare(a, b, row({0, 0, 0})).rmse == 0);
}

TEST_CASE("compare refuses pictures of different size", "[compare]") {
  CHECK_THROWS_AS(compare(Picture(2, 3, 1), Picture(3, 2, 1)), dermis::Error);
  CHECK_THROWS_AS(compare(Picture(2, 3, 1), Picture(2, 3, 3)), dermis::Error);
  CHECK_THROWS_AS(compare(Picture(2, 3, 1), Picture(2, 3, 1), Picture(2, 2, 1)), dermis::Error);
  CHECK_THROWS_AS(compare(Picture(2, 3, 1), Picture(2, 3, 1), Picture(2, 3, 3)), dermis::Error);
}

}  // namespace dermis::oracle
