// Where a picture's surfaces break off.
#pragma once

#include "dermis/oracle/picture.hpp"
#include "measure/picture_measurement.hpp"

namespace dermis::bench {

/// 1 where a pixel of some material lies within 3 px of an edge: of the frame's other materials or none, or of a depth
/// that differs from its neighbour's by more than the surface would if it were seen at 80 degrees.
oracle::Picture near_edges(const Subject& subject);

}  // namespace dermis::bench
