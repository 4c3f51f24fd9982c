/// Where the search for a projection begins: linear solutions, of all points or of few.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exr/projection.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {

using Rows = std::vector<std::size_t>;

/// A solution for some of the points; none if they do not determine one, for instance since they lie on one plane.
using LinearSolution = std::function<std::optional<Projection>(const SeenPoints&, const Rows&)>;

/// The parallel rays that show points in the middle of a projection where it does, with the axis along them.
Projection as_parallel(const Projection& projection);

/// The direct linear transform (Hartley and Zisserman 2004, algorithm 7.1), of 6 points or more.
std::optional<Projection> solve_lens(const SeenPoints& points, const Rows& rows);

/// The affine camera, of 4 points or more.
std::optional<Projection> solve_parallel(const SeenPoints& points, const Rows& rows);

/// A lens from positions and depths along the view axis, P = C + z x u + z y v + z w, of 4 points or more. `depth` has
/// that of each point, in units.
std::optional<Projection> solve_with_depth(const SeenPoints& points, std::span<const double> depth, const Rows& rows);

/// Indices of at most `count` points, evenly spread.
Rows spread(const SeenPoints& points, std::size_t count);

/// How badly a point is shown that is so far from its pixel: Cauchy's function, in which a few far ones do not outweigh
/// many near ones, whatever the scale. The median would not see what lies off a plane that takes most of the picture.
inline double score_of(double error_px) { return std::log1p(4 * error_px * error_px); }

/// The mean of the scores of some points.
double score(const SeenPoints& points, const Rows& rows, const Projection& projection);

/// The best of the solutions for few points, drawn at random so often that one of them is without a false point: by
/// their score, the best first; at most `most`.
std::vector<Projection> random_starts(const SeenPoints& points, const LinearSolution& solution, std::size_t sample,
                                      std::size_t most);

}  // namespace dermis::exr
