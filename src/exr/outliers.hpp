// Parts that fits which leave false points out have in common.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dermis::exr {

// Starts from so many points at random, of which one start without a false point is enough: of six points each all 64
// have one in less than a case of 10^8 if a fifth of the points is false, and in a third of the cases if half of them
// are.
inline constexpr int starts = 64;
inline constexpr std::size_t points_to_judge_start = 500;
inline constexpr int most_refits = 30;
inline constexpr double off_px = 1.0;  // a point farther off than this is left out

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// While a fit is still bent by false points, those within twice the median stay.
inline double limit_px(const std::vector<double>& errors_px) { return std::max(off_px, 2 * median(errors_px)); }

/// A fit to points that lie on a line may give NaNs, which have no order.
inline double error_or_huge(double error_px) { return std::isnan(error_px) ? HUGE_VAL : error_px; }

/// Indices of at most `count` out of `n` points, evenly spread.
inline std::vector<Eigen::Index> spread(std::size_t n, std::size_t count) {
  std::vector<Eigen::Index> out;
  const std::size_t step = (n + count - 1) / count;
  for (std::size_t i = 0; i < n; i += step) out.push_back(static_cast<Eigen::Index>(i));
  return out;
}

}  // namespace dermis::exr
