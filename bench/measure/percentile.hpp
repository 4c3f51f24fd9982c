// Order statistics of a few times.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace dermis::bench {

/// The value with `share` of the others below it; 0 if there are no values.
inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
}

}  // namespace dermis::bench
