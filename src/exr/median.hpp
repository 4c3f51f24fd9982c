/// The value in the middle, which false values do not move far.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dermis::exr {

/// Of at least one value, none of which is a NaN.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dermis::exr
