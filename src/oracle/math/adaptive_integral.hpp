/// Integrals to a stated accuracy.
#pragma once

#include <functional>

namespace dermis::oracle {

/// Returns the integral of f over from..to by Simpson's rule on `pieces` pieces, each of which is halved until its two
/// halves agree with the whole. The result is off by about `tolerance`, absolute.
double adaptive_integral(const std::function<double(double)>& f, double from, double to, int pieces, double tolerance);

}  // namespace dermis::oracle
