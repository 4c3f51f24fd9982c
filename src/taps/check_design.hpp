// The ranges of a design.
#pragma once

#include "dermis/taps.hpp"

namespace dermis {

constexpr int most_taps = 2047;  ///< of a pass

/// Throws Error(usage) that names what is out of range.
void check_design(const TapsDesign& design);

/// Throws Error(usage) if pixels cannot be of that size.
void check_pixel_mm(double pixel_mm);

}  // namespace dermis
