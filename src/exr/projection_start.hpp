/// Where the search for a projection begins: linear solutions, of all points or of few.
#pragma once

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

/// The direct linear transform (Hartley and Zisserman 2004, algorithm 7.1), of 6 points or more.
std::optional<Projection> solve_lens(const SeenPoints& points, const Rows& rows);

/// The affine camera, of 4 points or more.
std::optional<Projection> solve_parallel(const SeenPoints& points, const Rows& rows);

/// A lens from positions and depths along the view axis, P = C + z x u + z y v + z w, of 4 points or more. `depth` has
/// that of each point, in units.
std::optional<Projection> solve_with_depth(const SeenPoints& points, std::span<const double> depth, const Rows& rows);

/// Indices of at most `count` points, evenly spread.
Rows spread(const SeenPoints& points, std::size_t count);

/// The median of how far points are from their pixels.
double median_error_px(const SeenPoints& points, const Rows& rows, const Projection& projection);

/// The best of the solutions for few points, drawn at random so often that one of them is without a false point: by the
/// median error, the best first; at most `most`.
std::vector<Projection> random_starts(const SeenPoints& points, const LinearSolution& solution, std::size_t sample,
                                      std::size_t most);

}  // namespace dermis::exr
