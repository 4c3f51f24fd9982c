#include "profile/monotone_cubic.hpp"

#include <cmath>
#include <cstddef>

namespace dermis {

std::vector<double> monotone_slopes(std::span<const double> nodes, std::span<const double> values) {
  const std::size_t pieces = nodes.size() - 1;
  std::vector<double> secants(pieces);
  for (std::size_t i = 0; i < pieces; ++i) secants[i] = (values[i + 1] - values[i]) / (nodes[i + 1] - nodes[i]);
  std::vector<double> slopes(nodes.size());
  slopes.front() = secants.front();
  slopes.back() = secants.back();
  for (std::size_t i = 1; i < pieces; ++i) {
    const bool turns = secants[i - 1] * secants[i] <= 0;
    slopes[i] = turns ? 0 : (secants[i - 1] + secants[i]) / 2;
  }
  for (std::size_t i = 0; i < pieces; ++i) {
    if (secants[i] == 0) {
      slopes[i] = slopes[i + 1] = 0;
      continue;
    }
    const double steepness = std::hypot(slopes[i], slopes[i + 1]) / std::abs(secants[i]);
    if (steepness > 3) {
      slopes[i] *= 3 / steepness;
      slopes[i + 1] *= 3 / steepness;
    }
  }
  return slopes;
}

}  // namespace dermis
