// What the order and the precision of sums are worth: weighted means on the host, in float against double.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dermis::bench {

/// How many values a mean is taken of.
inline constexpr std::array<int, 4> sum_sizes = {17, 65, 257, 2000};

/// One way to compute a mean in float.
struct SumRow {
  std::string how;
  std::array<double, sum_sizes.size()> rms{};  ///< relative error, root mean square over the trials
  std::array<double, sum_sizes.size()> max{};  ///< the largest
};

/// Weighted means of light over six decades, 1e-3 to 1e3, by every way; weights fall off as a profile does and are all
/// above 0.
std::vector<SumRow> study_sums(std::uint32_t seed, int trials = 300);

}  // namespace dermis::bench
