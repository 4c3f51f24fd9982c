// The bounds of a weighted sum hold for float32 sums whose weights and values are as far off as they may be.
#include "oracle/math/weighted_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// A value with its bound, and a float32 value that a device may have for it.
struct Input {
  Bounded known;
  float held;

  /// `error` is relative to the value. Half the time the device's value lies at an end of the bound.
  Input(Random& random, double low, double high, double error) : held(static_cast<float>(random.uniform(low, high))) {
    const double off = error * std::abs(static_cast<double>(held));
    const double share = random.coin() ? random.uniform(-1, 1) : (random.coin() ? 1 : -1);
    known = {static_cast<double>(held) - share * off, off * (1 + 1e-15)};
  }
};

struct Taps {
  std::vector<Input> weights;
  std::vector<Input> values;
  WeightedSum sum;

  Taps(Random& random, int count, double lowest_weight, double base, double spread) {
    const double error = random.coin() ? 0 : std::exp(random.uniform(-20, -5));
    for (int i = 0; i < count; ++i) {
      weights.emplace_back(random, lowest_weight, 1.0 / count, error);
      values.emplace_back(random, base - spread, base + spread, random.coin() ? error : 0);
      sum.add(weights.back().known, values.back().known);
    }
  }
};

/// Sums up w (x - from) in random order and pairing, fused or not; `plus` is one more summand.
class FloatSum {
 public:
  FloatSum(const Taps& taps, Random& random) : taps_(taps), random_(random), fused_(random.coin()) {}

  float of_products(float from, float plus) {
    return add_up(plus, [&](float sum, std::size_t i) {
      const float x = from == 0 ? taps_.values[i].held : taps_.values[i].held - from;
      return fused_ ? std::fma(taps_.weights[i].held, x, sum) : sum + taps_.weights[i].held * x;
    });
  }

  float of_weights(float plus) {
    return add_up(plus, [&](float sum, std::size_t i) { return sum + taps_.weights[i].held; });
  }

 private:
  /// Adds up in one or two partial sums.
  template <typename Step>
  float add_up(float plus, const Step& step) {
    float sums[] = {plus, 0};
    const bool split = random_.coin();
    const bool backwards = random_.coin();
    const std::size_t count = taps_.weights.size();
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t i = backwards ? count - 1 - n : n;
      float& sum = sums[split ? i % 2 : 0];
      sum = step(sum, i);
    }
    return sums[0] + sums[1];
  }

  const Taps& taps_;
  Random& random_;
  bool fused_;
};

/// Checks a value, and returns the share of the bound that its error uses.
double check(float value, Bounded bounded) {
  const double error = std::abs(static_cast<double>(value) - bounded.value);
  if (!(error <= bounded.error)) FAIL_CHECK(value << " is " << error << " off, bound " << bounded.error);
  return error / bounded.error;
}

}  // namespace

TEST_CASE("the bound of a mean holds, for weights of either sign", "[weighted_sum]") {
  Random random(21);
  double worst = 0;
  for (int round = 0; round < 4000; ++round) {
    const int count = random.integer(1, round % 10 == 0 ? 500 : 25);
    const double lowest = random.coin() ? 0 : random.uniform(-0.5, 0) / count;
    const Taps taps(random, count, lowest, random.uniform(-2, 2), std::exp(random.uniform(-12, 2)));
    FloatSum device(taps, random);
    const Bounded mean = taps.sum.mean({});
    if (std::isinf(mean.error)) continue;
    worst = std::max(worst, check(device.of_products(0, 0) / device.of_weights(0), mean));
  }
  INFO("largest share of a bound " << worst);
  CHECK(worst > 0.3);
}

TEST_CASE("the bound of a difference holds in either form", "[weighted_sum]") {
  Random random(22);
  double worst = 0;
  for (int round = 0; round < 4000; ++round) {
    const int count = random.integer(0, round % 10 == 0 ? 500 : 25);
    const double base = random.uniform(-2, 2);
    const double spread = std::exp(random.uniform(-12, 2));
    const Taps taps(random, count, random.coin() ? 0 : -1.0 / std::max(count, 1), base, spread);
    const Input own(random, base - spread, base + spread, random.coin() ? 0 : 1e-4);
    const float total = random.coin() ? static_cast<float>(random.uniform(-2, 2)) : static_cast<float>(round % 2);
    const Bounded bounded = taps.sum.about(own.known, static_cast<double>(total));
    FloatSum device(taps, random);
    const float differences = device.of_products(own.held, total * own.held);
    const float missing = total - device.of_weights(0);
    const float products = device.of_products(0, 0) + missing * own.held;
    const float fused = std::fma(missing, own.held, device.of_products(0, 0));
    for (const float value : {differences, products, fused}) {
      if (bounded.error > 0) worst = std::max(worst, check(value, bounded));
    }
  }
  INFO("largest share of a bound " << worst);
  CHECK(worst > 0.3);
}

TEST_CASE("a mean by hand", "[weighted_sum]") {
  WeightedSum sum;
  sum.add(exact(0.5), exact(7));
  sum.add(exact(-0.25), exact(-1));
  const Bounded mean = sum.mean({});
  CHECK(mean.value == 15);
  // There are three roundings of sum |w x| and two of the mean times sum |w|, both over sum w, and six of the division.
  CHECK(mean.error == Approx(unit_roundoff * ((3 * 3.75 + 2 * 15 * 0.75) / 0.25 + 6 * 15)).epsilon(1e-5));
}

TEST_CASE("a difference by hand", "[weighted_sum]") {
  WeightedSum sum;
  CHECK(sum.about(exact(3), 0.5).value == 1.5);
  sum.add(exact(0.25), exact(7));
  sum.add(exact(-0.5), exact(1));
  CHECK(sum.about(exact(3), 0).value == 0.25 * 4 + 0.5 * 2);
  CHECK(sum.about(exact(3), 1).value == 3 + 0.25 * 4 + 0.5 * 2);
  // There are five roundings of |S x_p| + sum |w| (|x| + |x_p|).
  CHECK(sum.about(exact(3), 1).error == Approx(5 * unit_roundoff * (3 + 0.25 * 10 + 0.5 * 4)));
}

TEST_CASE("where all light is the same, errors of the weights do not count", "[weighted_sum]") {
  WeightedSum sum;
  for (const double weight : {0.5, 0.25, -0.125}) sum.add({weight, 0.01}, exact(2));
  CHECK(sum.mean({}).error < 1e-5);
  CHECK(sum.about(exact(2), 1).error < 1e-5);
  CHECK(sum.about(exact(2.1), 1).error > 1e-3);
}

TEST_CASE("a mean is bounded where its weights are known to be positive", "[weighted_sum]") {
  // The weights are 1/8 to 3/8 and 0 to 1/4, so that the mean lies in 1..5/3, and the least sum is 1/8.
  WeightedSum sum;
  sum.add({0.125, 0.25}, exact(1), 0.125);
  sum.add({0, 0.25}, exact(2), 0);
  CHECK(sum.mean({}).value == 1);
  CHECK(sum.mean({}).error == Approx(0.25 * (2 - 1) / 0.125).epsilon(1e-4));
}

TEST_CASE("a mean of weights that may cancel has no bound", "[weighted_sum]") {
  WeightedSum sum;
  sum.add({0.5, 0.01}, exact(2));
  sum.add({-0.485, 0.01}, exact(3));
  CHECK(sum.mean({}).error == std::numeric_limits<double>::infinity());
}

}  // namespace dermis::oracle
