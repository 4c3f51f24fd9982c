// What the taps of a level are worth on flat and on smooth blocks.
#pragma once

#include <array>
#include <vector>

#include "dermis/taps.hpp"
#include "taps/placement/tap_fit.hpp"

namespace dermis {

// All of them are rows of weights per channel, of all terms of each row.

/// In quanta that sum to what they should.
std::vector<std::array<float, 3>> make_flat_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                    const PlacedTaps& placed, double stretch);

/// How the flat weights change with q, see Taps: as secants over the range that q may have.
std::vector<std::array<float, 3>> make_stretch_weights(const TapLevel& level, const std::vector<Term>& terms,
                                                       const PlacedTaps& placed);

/// How the flat weights change with k, see Taps: if the length of surface under a tap grows by one part per pixel from
/// the centre on, its distance grows by half of that.
std::vector<std::array<float, 3>> make_skew_weights(const TapLevel& level, const std::vector<Term>& terms);

}  // namespace dermis
