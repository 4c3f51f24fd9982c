// Weighted means on the host, in float against double: the worth of the order and of the precision of sums.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dermis::bench {

/// Numbers of values that a mean is taken of.
inline constexpr std::array<int, 4> sum_sizes = {17, 65, 257, 2000};

/// One way to compute a mean in float.
struct SumRow {
  std::string how;
  std::array<double, sum_sizes.size()> rms{};  ///< relative error, root mean square over the trials
  std::array<double, sum_sizes.size()> max{};  ///< the largest
};

/// Takes weighted means of light over six decades, 1e-3 to 1e3, in every way; the weights are above 0 and fall as those
/// of a profile do.
std::vector<SumRow> study_sums(std::uint32_t seed, int trials = 300);

}  // namespace dermis::bench
