// How far random walks in a half-space come, by what each scattering absorbs.
#pragma once

#include <array>

namespace dermis {

/// The share 2 pi r R(r) of the light of a point that leaves at r, as a sum of exponentials: of weight times
/// e^(-r/d) / d, with d the length of the same place in `walk_lengths`. Weights of a row sum to 1 but for rounding.
/// Lengths are in mean free paths.
struct WalkRow {
  double absorbed;  ///< 1 - albedo of a single scattering
  std::array<double, 18> weight;
};

extern const std::array<double, 18> walk_lengths;  ///< ascending

/// By falling absorption, which ends with 0. How it is made: bench/walk/walk_table.cpp.
extern const std::array<WalkRow, 48> walk_table;

}  // namespace dermis
