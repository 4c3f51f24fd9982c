#include "taps/check_design.hpp"

#include <string>

#include "dermis/error.hpp"

namespace dermis {

namespace {

/// What a design may ask for of a model.
int highest_rank(Model model) {
  switch (model) {
    case Model::svd:
    case Model::gaussians:
      return 6;
    case Model::optimised:
      return 3;
    case Model::pre_integrated:
    case Model::artist:
    case Model::guided:
      break;
  }
  return 1;
}

}  // namespace

void check_design(const TapsDesign& design) {
  constexpr int most_taps = 2047;
  const int ranks = highest_rank(design.model);
  if (design.rank < 1 || design.rank > ranks) {
    throw Error(ErrorCode::usage, "rank", std::to_string(design.rank),
                ranks == 1 ? "1 for this model" : "1.." + std::to_string(ranks) + " for this model");
  }
  if (design.count < 3 || design.count > most_taps || design.count % 2 == 0) {
    throw Error(ErrorCode::usage, "taps", std::to_string(design.count), "an odd number, 3..2047");
  }
  if (!(design.guide >= 0 && design.guide <= 4)) {
    throw Error(ErrorCode::usage, "guide", std::to_string(design.guide), "0..4");
  }
}

}  // namespace dermis
