/// A function of distance as a float32 device reads it from a table.
#pragma once

#include <functional>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// Reads f(channel, r), given r^2 and the width factor as a device has them. The bound holds for a table that is linear
/// in r^2 between 256 nodes or more in each octave.
class ProfileTable {
 public:
  using Function = std::function<double(int channel, double r_mm)>;

  /// Keeps a reference to `f`.
  explicit ProfileTable(const Function& f) : f_(f) {}

  /// Returns f(r / k), where k is the width factor.
  Bounded at(int channel, Bounded r_squared, Bounded width_factor) const;

 private:
  const Function& f_;
};

}  // namespace dermis::oracle
