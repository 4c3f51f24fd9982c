// What a kernel wrote, held against the oracle.
#pragma once

#include <algorithm>
#include <cmath>

#include "dermis/oracle/reference.hpp"
#include "inputs/half.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

struct Tally {
  double worst = 0;          ///< error / bound
  double largest_bound = 0;  ///< relative to the largest value
  long values = 0;
  long loose = 0;    ///< of which the bound is more than a hundredth of the largest one of the frame
  long changed = 0;  ///< that differ from the light
};

inline void compare(const GuardedImage& output, const dermis::oracle::Picture& expected,
                    const dermis::oracle::Picture& bound, Tally& tally) {
  double largest = 0;
  for (const double value : expected.values) largest = std::max(largest, std::abs(value));
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = expected(x, y, c);
        const bool half = output.layout().format == dermis::Format::f16;
        const double allowed = bound(x, y, c) + (half ? dermis::bench::half_last_place(value) / 2 : 0);
        const double error = std::abs(output.get(x, y, c) - value);
        tally.largest_bound = std::max(tally.largest_bound, bound(x, y, c) / largest);
        ++tally.values;
        if (bound(x, y, c) > 0.01 * largest) ++tally.loose;
        if (!half && error > 0) tally.worst = std::max(tally.worst, error / allowed);
        if (!(error <= allowed)) {
          CAPTURE(x, y, c, value, output.get(x, y, c), error, allowed);
          REQUIRE(error <= allowed);
        }
      }
    }
  }
}

/// Both outputs of a frame, and the bytes around them.
inline void compare(const RandomFrame& frame, const dermis::oracle::Reference& expected, Tally& tally) {
  compare(*frame.scattered, expected.scattered, expected.scattered_bound, tally);
  CHECK(frame.scattered->guards_intact());
  if (frame.result) {
    compare(*frame.result, expected.result, expected.result_bound, tally);
    CHECK(frame.result->guards_intact());
  }
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (expected.touched(x, y) == 0) continue;
      for (int c = 0; c < 3; ++c) {
        if (std::abs(expected.scattered(x, y, c) - frame.light->get(x, y, c)) > 1e-3) ++tally.changed;
      }
    }
  }
}
