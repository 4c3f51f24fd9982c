// Images of RGB floats: as the oracle's pictures, and how far they are apart.
#pragma once

#include <cmath>
#include <vector>

#include "dermis/oracle/picture.hpp"

inline dermis::oracle::Picture picture_of(int width, int height, const std::vector<float>& rgb) {
  dermis::oracle::Picture picture(width, height, 3);
  picture.values.assign(rgb.begin(), rgb.end());
  return picture;
}

/// Returns the L2 distance of `a` from the reference `b`, relative to `b`.
inline double relative_l2(const std::vector<float>& a, const std::vector<float>& b) {
  double errors = 0;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto off = static_cast<double>(a[i] - b[i]);
    errors += off * off;
    squares += static_cast<double>(b[i]) * static_cast<double>(b[i]);
  }
  return std::sqrt(errors / squares);
}
