#include "taps/tables/flat_weights.hpp"

#include <algorithm>
#include <cstddef>

#include "taps/tables/quanta.hpp"

namespace dermis {

std::vector<std::array<float, 3>> make_flat_weights(const SurfaceWeights& weights, double stretch) {
  const std::size_t rows = weights.rows();
  const std::size_t terms = weights.terms().size();
  std::vector<std::array<float, 3>> result(rows * terms);
  std::vector<double> stretched(rows * weights.functions());
  for (std::size_t row = 0; row < rows; ++row) {
    weights.on_surface(row, stretch, stretch, &stretched[row * weights.functions()]);
  }
  std::vector<double> its(rows);
  for (int c = 0; c < 3; ++c) {
    for (std::size_t t = 0; t < terms; ++t) {
      const TermCurves& term = weights.terms()[t];
      // They are those that were fitted, changed as those on a surface change with the size of a pixel.
      double total = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t function = 3 * t + static_cast<std::size_t>(c);
        its[row] = weights.fitted(row, t, c) + stretched[row * weights.functions() + function] -
                   weights.on_plane(row)[function];
        if (term.normalised) its[row] = std::max(its[row], 0.0);
        total += row == 0 ? its[row] : 2 * its[row];
      }
      const double scale = term.normalised && total > 0 ? 1 / total : 1;
      double pairs = 0;
      for (std::size_t row = 1; row < rows; ++row) {
        const double weight = in_quanta(its[row] * scale);
        result[row * terms + t][c] = static_cast<float>(weight);
        pairs += 2 * weight;
      }
      result[t][c] = static_cast<float>(in_quanta(term.sum[c]) - pairs);
    }
  }
  return result;
}

}  // namespace dermis
