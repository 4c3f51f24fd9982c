// Discrete Fourier transforms of square pictures that repeat at their edges.
#pragma once

#include <algorithm>
#include <complex>
#include <vector>

namespace dermis::bench {

/// side_px x side_px values, row by row: of pixels or of frequencies.
using Spectrum = std::vector<std::complex<double>>;

/// Transforms in place, without a factor: there and back multiplies by side_px^2.
void to_frequencies(Spectrum& values, int side_px);
void to_pixels(Spectrum& values, int side_px);

/// The distance of a row or column from 0 in a square of side `side` that repeats: 0..side / 2.
inline int mirrored(int i, int side) { return std::min(i, side - i); }

/// Power of a picture at the frequencies 0..side_px / 2 by 0..side_px / 2, row by row; each holds those of its mirror
/// images, too, which a kernel that is even in x and y does not tell apart.
std::vector<double> power_of(const std::vector<double>& picture, int side_px);

}  // namespace dermis::bench
