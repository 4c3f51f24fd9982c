/// What a float32 device reads of a function of distance from a table.
#pragma once

#include <functional>

#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// f(channel, r), with r^2 and the width factor as a device has them, from a table that is linear in r^2 between 256
/// nodes or more in each octave.
class ProfileTable {
 public:
  using Function = std::function<double(int channel, double r_mm)>;

  /// Keeps a reference to `f`.
  explicit ProfileTable(const Function& f) : f_(f) {}

  /// f(r / k).
  Bounded at(int channel, Bounded r_squared, Bounded width_factor) const;

 private:
  const Function& f_;
};

}  // namespace dermis::oracle
