/// Curves that show what taps do to light.
#pragma once

#include <vector>

#include "dermis/taps.hpp"

namespace dermis::program {

/// A point of a curve, per channel.
struct CurvePoint {
  double x;
  Rgb value;
};

using Curve = std::vector<CurvePoint>;

/// A slice of the kernel of the plane through its middle; x is the distance, mm.
struct Slice {
  Curve truth;    ///< light of the profile on a pixel by the area of the pixel, 1/mm^2
  Curve product;  ///< the same of the sum of products
};

/// `dense` has a tap on every pixel. On at most `most` pixels, evenly.
Slice axis_slice(const Profile& profile, const TapSet& dense, int most);
Slice diagonal_slice(const Profile& profile, const TapSet& dense, int most);

/// The first `count` singular values, or fewer, of the profile on pixels by the first of them; x counts from 1.
/// The matrix has at most 64 pixels to either side of the middle: they are made larger than those of `dense` if those
/// are more.
Curve singular_values(const Profile& profile, const TapSet& dense, int count);

/// The answer of the taps to light of 1 on all pixels right of an edge between two pixels, at most `most` of them
/// evenly; x is the distance from the edge, mm. `exact` is Profile::edge.
struct StepResponse {
  Curve exact;
  Curve taps;
};

StepResponse step_response(const Profile& profile, const TapSet& set, double radius_mm, int most);

}  // namespace dermis::program
