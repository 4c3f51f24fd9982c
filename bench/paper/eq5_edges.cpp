// The text after eq. 5: straight shadow boundaries of arbitrary orientation.
#include <fmt/format.h>

#include "paper/study.hpp"

namespace dermis::bench {

Claims edges(const Study& study) {
  constexpr double rounding = 1e-6;
  const Edge at_30(30);
  const Edge at_45(45);
  Evidence found;
  for (const Medium& medium : study.media) {
    const Sample& sample = medium.sample;
    const double at_30_rank_1 = at_30.max_error(medium.rank_1, sample);
    const double at_45_rank_1 = at_45.max_error(medium.rank_1, sample);
    const double rank_2 = at_30.max_error(dense_model(sample, Model::optimised, 2), sample);
    const double rank_3 = at_30.max_error(dense_model(sample, Model::optimised, 3), sample);
    found.add(sample.name,
              fmt::format("{} at 30 degrees, {} at 45; dermis' rank 2 {}, rank 3 {} at 30", percent(at_30_rank_1),
                          percent(at_45_rank_1), percent(rank_2), percent(rank_3)),
              {{"degrees_30", at_30_rank_1},
               {"degrees_45", at_45_rank_1},
               {"degrees_30_dermis_rank_2", rank_2},
               {"degrees_30_dermis_rank_3", rank_3}},
              at_30_rank_1 <= rounding && at_45_rank_1 <= rounding);
  }
  return {found.claim("eq5_edges", "text after eq. 5",
                      "pre-integration is exact for straight shadow boundaries at any angle",
                      "largest error at most 1e-6 of the peak at 30 and 45 degrees", "largest error:")};
}

}  // namespace dermis::bench
