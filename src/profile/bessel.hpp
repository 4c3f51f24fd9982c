// Bessel's function of order 0.
#pragma once

namespace dermis {

/// J0(z), z >= 0, to 1e-15.
double bessel_j0(double z);

}  // namespace dermis
