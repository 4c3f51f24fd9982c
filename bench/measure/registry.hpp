// All cases there are.
#pragma once

#include <string>
#include <vector>

#include "measure/case.hpp"

namespace dermis::bench {

/// The cases on made scenes that are measured unless told otherwise: each axis around 1920x1080, full coverage, a
/// kernel of 16 px, rank 2 and 17 taps.
std::vector<Case> default_cases();

/// Every combination of methods, ranks, taps, widths, coverages, sizes and threads on made scenes, for --filter to
/// choose from.
std::vector<Case> all_cases();

/// The cases on a picture: the separable method over models, ranks and tap counts, plain and with rotated taps; and
/// discs; and the opponents that know materials or depth.
std::vector<Case> picture_cases();

/// The case that stands beside all others on a picture: the exact method, whose result is their truth.
Case picture_reference();

/// Keeps the cases whose name has a match of the regular expression (ECMAScript); all if it is empty. Throws
/// Error(usage) that names --filter if it is malformed or matches nothing.
std::vector<Case> matching(std::vector<Case> cases, const std::string& expression);

}  // namespace dermis::bench
