// Positions and weights of taps, fitted together.
#pragma once

#include <array>
#include <vector>

#include "dermis/taps.hpp"
#include "taps/prediction/expected_error.hpp"

namespace dermis {

/// Taps on one side of the centre, and their weights.
struct PlacedTaps {
  std::vector<double> offsets_px;  ///< ascending, > 0
  /// Weights per channel: a row for the centre, then one for each pair (of one of its taps); a column for each term.
  std::array<Eigen::MatrixXd, 3> weights;
};

/// The responses of placed taps in one channel, for taps that read whole pixels or between two.
Responses responses_of(const PlacedTaps& taps, int channel, const PowerGrid& grid);

/// Most taps on one side that are fitted; more are not worth the search.
inline constexpr int most_fitted_pairs = 32;

/// The range of a search for positions.
enum class Search {
  everywhere,  ///< from several starts
  nearby,      ///< the given ones are of taps for about this size
  nowhere,     ///< keep the given ones
};

/// Moves taps from where they are to where the error on natural images is least, and weighs them. `sums`, per channel
/// and term, are those that weights keep. `joint`: the terms are changed together to meet the profile; else each
/// to meet its own function. Terms marked in `non_negative` have no negative weight. No tap goes beyond farthest_px.
PlacedTaps fit_taps(const std::array<ChannelOnPixels, 3>& channels, std::vector<double> offsets_px, Search how,
                    int farthest_px, Fetch fetch, bool joint, const std::vector<bool>& non_negative,
                    const std::array<Eigen::VectorXd, 3>& sums);

}  // namespace dermis
