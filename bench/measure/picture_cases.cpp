#include "measure/picture_cases.hpp"

namespace dermis::bench {

namespace {

PictureCase by_importance(int count) {
  return {"importance-sampled, " + std::to_string(count) + " taps",
          "importance-sampled",
          {.taps = {.model = Model::pre_integrated, .count = count, .placement = Placement::importance}}};
}

PictureCase optimised(int rank, int count) {
  const std::string series = "optimised, rank " + std::to_string(rank);
  return {series + ", " + std::to_string(count) + " taps", series, {.taps = {.rank = rank, .count = count}}};
}

PictureCase disc(int samples, bool prefiltered) {
  const std::string series = prefiltered ? "discs, prefiltered" : "discs";
  return {series + ", " + std::to_string(samples) + " samples",
          series,
          {.method = Method::disc, .disc = {.samples = samples, .prefiltered = prefiltered}}};
}

PictureCase jittered(PictureCase what, double jitter) {
  what.series.clear();
  what.name += jitter < 0.2 ? ", jitter 0.1" : ", jitter 0.3";
  what.options.jitter = jitter;
  return what;
}

}  // namespace

std::vector<PictureCase> picture_cases() {
  std::vector<PictureCase> cases;
  for (const int count : {7, 17, 25}) cases.push_back(by_importance(count));
  for (const int count : {7, 11, 17, 25, 33}) cases.push_back(optimised(1, count));
  for (const int count : {11, 17, 25, 33}) cases.push_back(optimised(2, count));
  cases.push_back(optimised(3, 25));
  cases.push_back({"4 Gaussians, 17 taps", "", {.taps = {.model = Model::gaussians, .rank = 4, .count = 17}}});
  PictureCase plain = optimised(2, 17);
  plain.series.clear();
  plain.name += ", plain passes";
  plain.options.sheared = false;
  cases.push_back(plain);
  cases.push_back(jittered(optimised(2, 17), 0.1));
  cases.push_back(jittered(optimised(2, 17), 0.3));
  for (const bool prefiltered : {false, true}) {
    for (const int samples : {21, 55}) cases.push_back(disc(samples, prefiltered));
  }
  return cases;
}

}  // namespace dermis::bench
