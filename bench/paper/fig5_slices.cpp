// Figure 5: slices of the pre-integrated kernel.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "paper/study.hpp"
#include "report/panel.hpp"

namespace dermis::bench {

namespace {

/// Pixels from the middle to a distance, along an axis or a diagonal.
int pixels_to(double r_mm, double pixel_mm, bool diagonal) {
  return static_cast<int>(std::lround(r_mm / (pixel_mm * (diagonal ? std::numbers::sqrt2 : 1))));
}

/// The pre-integrated kernel over the exact one, i pixels out.
double ratio(const Medium& medium, int channel, int i, bool diagonal) {
  const Eigen::VectorXd& a = medium.rank_1[channel][0].f;
  const int other = diagonal ? i : 0;
  return a[i] * a[other] / medium.sample.exact[channel](i, other);
}

Panel slice(const Medium& medium, int channel, bool diagonal) {
  constexpr double range_mm = 10;
  const double pixel_mm = medium.sample.pixel_mm;
  const double area_mm2 = pixel_mm * pixel_mm;
  const Eigen::VectorXd& a = medium.rank_1[channel][0].f;
  Curve exact{"exact", "lines lc rgb '#999999' lw 5", {}};
  Curve approximate{"pre-integrated", fmt::format("lines lc rgb '{}' lw 2", channel_colours[channel]), {}};
  const int last = pixels_to(range_mm, pixel_mm, diagonal);
  for (int i = -last; i <= last; ++i) {
    const int at = std::abs(i);
    const int other = diagonal ? at : 0;
    const double r_mm = i * pixel_mm * (diagonal ? std::numbers::sqrt2 : 1);
    exact.add(r_mm, medium.sample.exact[channel](at, other) / area_mm2);
    approximate.add(r_mm, a[at] * a[other] / area_mm2);
  }
  return {fmt::format("{}: {} slice, {}", medium.sample.name, diagonal ? "diagonal" : "axis", channel_names[channel]),
          "set logscale y\nset yrange [1e-10:1e4]\nset xrange [-10:10]\nset format y '10^{%T}'\n"
          "set xlabel 'distance, mm'\nset ylabel 'kernel, 1/mm^2'\nset key top right",
          {exact, approximate}};
}

Claim slices_differ(const Study& study) {
  constexpr double factor = 2;
  Evidence found;
  for (const Medium& medium : study.media) {
    const Sample& sample = medium.sample;
    const int channel = sample.profile.widest_channel();
    const double within_mm = sample.profile.radius(channel, 0.999);
    double largest = 0;
    for (int i = 1; i * sample.pixel_mm <= within_mm; ++i) {
      const int on_diagonal = pixels_to(i * sample.pixel_mm, sample.pixel_mm, true);
      largest = std::max(largest, ratio(medium, channel, i, false) / ratio(medium, channel, on_diagonal, true));
    }
    Json at;
    std::vector<std::string> pairs;
    for (const double share : {0.5, 0.9, 0.99, 0.999}) {
      const double r_mm = sample.profile.radius(channel, share);
      const double axis = ratio(medium, channel, pixels_to(r_mm, sample.pixel_mm, false), false);
      const double diagonal = ratio(medium, channel, pixels_to(r_mm, sample.pixel_mm, true), true);
      at.push_back({{"r_mm", r_mm}, {"light_within", share}, {"axis", axis}, {"diagonal", diagonal}});
      pairs.push_back(fmt::format("{:.2g} mm {:.2g} / {:.2g}", r_mm, axis, diagonal));
    }
    found.add(sample.name, fmt::format("{}, {}", channel_names[channel], fmt::join(pairs, ", ")),
              {{"channel", channel_names[channel]}, {"over_exact", at}, {"largest_axis_over_diagonal", largest}},
              largest > factor);
  }
  return found.claim("fig5_slices", "Fig. 5",
                     "the pre-integrated kernel is not round: its axis and diagonal slices differ",
                     "by more than 2 times somewhere within 99.9 % of the light",
                     "over the exact kernel along axis / diagonal, where 50, 90, 99, 99.9 % of the light lie within:");
}

}  // namespace

Claims fig5(const Study& study) {
  std::vector<Panel> panels;
  for (const bool diagonal : {false, true}) {
    for (int c = 0; c < 3; ++c) panels.push_back(slice(study.skin(), c, diagonal));
  }
  draw("--paper", study.folder / "fig5.svg", panels, 3);
  return {slices_differ(study)};
}

}  // namespace dermis::bench
