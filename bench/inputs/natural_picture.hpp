// Pictures with the statistics of natural images.
#pragma once

#include <cstdint>
#include <vector>

namespace dermis::bench {

/// The exponential of noise whose amplitude falls as 1 / frequency, with a standard deviation of half its mean:
/// side_px x side_px values that repeat at their edges.
std::vector<double> natural_picture(int side_px, std::uint32_t seed);

}  // namespace dermis::bench
