// Weights of the taps of a level on flat and on smooth blocks.
#pragma once

#include <array>
#include <vector>

#include "dermis/tap_tables.hpp"
#include "taps/placement/tap_fit.hpp"

namespace dermis {

// All results list weights tap by tap, each tap with all its terms, as TapLevel has them.

/// Flat weights for a surface whose pixels are `stretch` times as long as the level's, rounded to quanta that sum to
/// the term's sum.
std::vector<std::array<float, 3>> make_flat_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                    const PlacedTaps& placed, double stretch);

/// Change of the flat weights with q, see Taps: secants over the range that q may have.
std::vector<std::array<float, 3>> make_stretch_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                       const PlacedTaps& placed);

/// Change of the flat weights with k, see Taps: if the length of surface under a tap grows by one part per pixel from
/// the centre on, its distance grows by half of that.
std::vector<std::array<float, 3>> make_skew_weights(const TapLevel& level, const std::vector<Term>& terms);

}  // namespace dermis
