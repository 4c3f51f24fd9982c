// What a design may ask for.
#pragma once

#include "dermis/taps.hpp"

namespace dermis {

/// Throws Error(usage) that names what is out of range.
void check_design(const TapsDesign& design);

}  // namespace dermis
