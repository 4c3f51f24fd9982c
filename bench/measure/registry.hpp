// All cases there are.
#pragma once

#include <string>
#include <vector>

#include "measure/case.hpp"

namespace dermis::bench {

/// The cases that are measured unless told otherwise: each axis around 1920x1080, full coverage, a kernel of 16 px,
/// rank 2 and 17 taps.
std::vector<Case> default_cases();

/// Every combination of methods, ranks, taps, widths, coverages, sizes and threads, for --filter to choose from.
std::vector<Case> all_cases();

}  // namespace dermis::bench
