#include "stress/errors.hpp"

#include <algorithm>
#include <cmath>

#include "inputs/half.hpp"

namespace dermis::bench {

namespace {

/// The oracle is sure of values whose bound is at most this share of the largest value.
constexpr double sure_bound = 1e-4;

/// Distance from a value to the next one of the format.
double last_place(Format format, double value) {
  if (format == Format::f16) return half_last_place(value);
  return std::ldexp(1.0, (value == 0 ? -126 : std::max(-126, std::ilogb(std::abs(value)))) - 23);
}

}  // namespace

void StressErrors::add(const oracle::Picture& seen, int seen_x, const oracle::Reference& expected, int expected_x,
                       int width) {
  double largest = 0;
  for (const double value : expected.scattered.values) largest = std::max(largest, std::abs(value));
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = seen(seen_x + x, y, c);
        const double truth = expected.scattered(expected_x + x, y, c);
        const double bound = expected.scattered_bound(expected_x + x, y, c);
        ++values_;
        if (!std::isfinite(value)) {
          ++non_finite_;
          continue;
        }
        const double error = std::abs(value - truth);
        const double allowed = bound + (format_ == Format::f16 ? 0.5 * last_place(format_, truth) : 0);
        if (error > 0) of_bound_ = std::max(of_bound_, error / allowed);
        all_.add(error, truth, last_place(format_, truth));
        if (bound > sure_bound * largest) continue;
        ++sure_;
        of_sure_.add(error, truth, last_place(format_, truth));
      }
    }
  }
}

void StressErrors::Sums::add(double error, double truth, double last_place) {
  errors2 += error * error;
  truths2 += truth * truth;
  max_ulp = std::max(max_ulp, error / last_place);
  if (truth != 0) max_rel = std::max(max_rel, error / std::abs(truth));
}

void StressErrors::write_to(StressRow& row, bool sure_values_only) const {
  const Sums& sums = sure_values_only ? of_sure_ : all_;
  row.rel_l2 = sums.errors2 == 0 ? 0 : std::sqrt(sums.errors2 / sums.truths2);
  row.max_rel = sums.max_rel;
  row.max_ulp = sums.max_ulp;
  row.of_bound = of_bound_;
  row.non_finite = non_finite_;
}

}  // namespace dermis::bench
