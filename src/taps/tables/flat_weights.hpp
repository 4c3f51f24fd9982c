// Weights of the taps of a level on flat blocks.
#pragma once

#include <array>
#include <vector>

#include "taps/tables/surface_weights.hpp"

namespace dermis {

/// Weights for a surface whose pixels are `stretch` times as long as the level's, rounded to quanta that sum to the
/// term's sum. They are listed as in TapLevel::flat_weights.
std::vector<std::array<float, 3>> make_flat_weights(const SurfaceWeights& weights, double stretch);

}  // namespace dermis
