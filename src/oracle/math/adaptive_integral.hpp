/// Integrals to a stated accuracy.
#pragma once

#include <functional>

namespace dermis::oracle {

/// The integral of f over from..to by Simpson's rule on that many pieces, each halved until two halves agree with their
/// whole; off by about `tolerance`, absolute.
double adaptive_integral(const std::function<double(double)>& f, double from, double to, int pieces, double tolerance);

}  // namespace dermis::oracle
