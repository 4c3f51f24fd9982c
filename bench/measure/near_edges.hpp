// The pixels of a picture where its surfaces break off.
#pragma once

#include <vector>

#include "measure/scene.hpp"

namespace dermis::bench {

/// True for every pixel within 3 px of an edge: a neighbour has another material id or none, or its depth differs by
/// more than it would on a surface seen at 80 degrees.
std::vector<bool> near_edges(const Scene& scene);

}  // namespace dermis::bench
