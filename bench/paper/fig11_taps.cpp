// Figure 11: importance sampling, and the number of taps that it takes.
#include <fmt/format.h>

#include "paper/study.hpp"
#include "report/panel.hpp"

namespace dermis::bench {

namespace {

struct Design {
  std::string title;
  const char* style;
  TapsDesign design;
};

const std::vector<Design>& designs() {
  using enum Placement;
  static const std::vector<Design> all = {{"uniform",
                                           "linespoints lc rgb '#d1495b' lw 2 pt 5 ps 0.6",
                                           {.model = Model::pre_integrated, .placement = uniform}},
                                          {"quadratic",
                                           "linespoints lc rgb '#e08e1b' lw 2 pt 13 ps 0.7",
                                           {.model = Model::pre_integrated, .placement = quadratic}},
                                          {"importance",
                                           "linespoints lc rgb '#2f6db5' lw 2 pt 7 ps 0.6",
                                           {.model = Model::pre_integrated, .placement = importance}},
                                          {"optimised, rank 1",
                                           "linespoints lc rgb '#2a8f6f' lw 2 pt 9 ps 0.7",
                                           {.model = Model::optimised, .placement = optimised}},
                                          {"optimised, rank 2",
                                           "linespoints lc rgb '#7a4fa3' lw 2 pt 11 ps 0.7",
                                           {.model = Model::optimised, .rank = 2, .placement = optimised}}};
  return all;
}

Products taps_of(const Sample& sample, TapsDesign design, int count, Fetch fetch = Fetch::integer) {
  design.count = count;
  return products_of(make_tap_set(sample.profile, design, sample.pixel_mm, fetch));
}

Panel errors_by_count(const Study& study, const Sample& sample, double width) {
  constexpr std::array counts = {3, 5, 7, 9, 11, 13, 17, 21, 25, 33, 49, 65};
  Panel panel{
      fmt::format("{}, W = {} px", sample.name, width),
      "set logscale xy\nset yrange [1e-4:0.6]\nset xrange [2.7:72]\nset xtics (3, 5, 7, 11, 17, 25, 33, 49, 65)\n"
      "set format y '10^{%T}'\nset xlabel 'taps per pass'\n"
      "set ylabel 'relative L2 error on natural pictures'\nset key bottom left"};
  for (const Design& one : designs()) {
    Curve curve{one.title, one.style, {}};
    for (const int count : counts) {
      curve.add(count, study.natural.rel_l2(taps_of(sample, one.design, count), sample));
    }
    panel.curves.push_back(curve);
  }
  const double every_pixel = study.natural.rel_l2(pre_integrated(sample.profile, sample.pixel_mm), sample);
  panel.curves.push_back(
      {"pre-integrated, every pixel", "lines lc rgb '#666666' lw 1.5 dt 2", {{2.7, every_pixel}, {72, every_pixel}}});
  return panel;
}

/// Errors of one profile at one width.
struct SevenTaps {
  std::string name;
  double uniform, importance, optimised, many;  ///< against the exact convolution; `many` is uniform 513
  double uniform_added, importance_added;       ///< against uniform 513
  double importance_linear_added;               ///< against uniform 513, read by linear interpolation
  int faithful_taps;                            ///< importance-sampled ones that add no more than `many` is off
};

SevenTaps seven_taps_of(const Study& study, const std::string& name, const Sample& sample) {
  constexpr int few = 7;
  const auto& all = designs();
  const Products many = taps_of(sample, all[0].design, 513);
  const Products uniform = taps_of(sample, all[0].design, few);
  const Products importance = taps_of(sample, all[2].design, few);
  const Products linear = taps_of(sample, all[2].design, few, Fetch::linear);
  const auto error = [&](const Products& products) { return study.natural.rel_l2(products, sample); };
  const auto added = [&](const Products& products) { return study.natural.rel_l2(products, many); };
  int faithful_taps = 3;
  while (added(taps_of(sample, all[2].design, faithful_taps)) > error(many)) faithful_taps += 2;
  return {name,         error(uniform), error(importance), error(taps_of(sample, all[3].design, few)),
          error(many),  added(uniform), added(importance), added(linear),
          faithful_taps};
}

}  // namespace

Claims fig11(const Study& study) {
  const Sample& skin = study.skin().sample;
  const Sample& burley = study.media[1].sample;
  draw("--paper", study.folder / "fig11.svg",
       {errors_by_count(study, skin, width_px), errors_by_count(study, study.wider[0], 2 * width_px),
        errors_by_count(study, burley, width_px)},
       3);

  Evidence better, faithful;
  for (const SevenTaps& row :
       {seven_taps_of(study, "skin W=16", skin), seven_taps_of(study, "skin W=32", study.wider[0]),
        seven_taps_of(study, "skin-measured W=16", burley),
        seven_taps_of(study, "skin-measured W=32", study.wider[1])}) {
    const Json numbers = {{"uniform_7", row.uniform},
                          {"importance_7", row.importance},
                          {"optimised_7", row.optimised},
                          {"uniform_513", row.many},
                          {"uniform_7_from_513", row.uniform_added},
                          {"importance_7_from_513", row.importance_added},
                          {"importance_7_linear_from_513", row.importance_linear_added},
                          {"importance_taps_for_faithful", row.faithful_taps}};
    better.add(row.name,
               fmt::format("{} against {} (read linearly: {})", percent(row.importance_added),
                           percent(row.uniform_added), percent(row.importance_linear_added)),
               numbers, row.importance_added <= row.uniform_added / 2);
    faithful.add(
        row.name,
        fmt::format("{}, optimised {}, uniform {}, uniform 513 {}; faithful takes {} taps", percent(row.importance),
                    percent(row.optimised), percent(row.uniform), percent(row.many), row.faithful_taps),
        numbers, row.importance_added <= row.many);
  }
  return {
      better.claim("fig11_importance", "Fig. 11", "7 importance-sampled taps do far better than 7 uniform ones",
                   "at most half as far from 513 uniform taps, on natural pictures", "distance from 513 uniform taps:"),
      faithful.claim("fig11_seven_taps", "Fig. 11, Section 6", "7 importance-sampled taps are faithful",
                     "they are no further from 513 uniform taps than those are from the exact convolution",
                     "error of 7 taps against the exact convolution:")};
}

}  // namespace dermis::bench
