// Weights of the taps of a level on curved blocks.
#pragma once

#include <vector>

#include "dermis/tap_tables.hpp"
#include "taps/tables/surface_weights.hpp"

namespace dermis {

/// The nearness of the centre and of each pair, and their weights, as in TapLevel.
struct CurvedWeights {
  std::vector<Nearness> nearness;
  std::vector<CubicWeight> weights;
};

/// Fits cubics to the weights as functions of the squared distance of a pair, and of the length of surface of the
/// centre. They are exact on the plane of the level, and near by least squares where the square is .8 to 50 times as
/// large. A pair of a normalised term weighs nowhere less than 0, and no pair anything beyond twice the radius.
CurvedWeights fit_curved_weights(const SurfaceWeights& weights, double radius_mm);

}  // namespace dermis
