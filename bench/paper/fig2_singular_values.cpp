// Figure 2: the decay of singular values.
#include <fmt/format.h>

#include <algorithm>

#include "paper/study.hpp"
#include "report/panel.hpp"

namespace dermis::bench {

namespace {

constexpr int most_values = 20;

double relative(const Svd& svd, int channel, int number) {
  return svd.values[channel][number] / svd.values[channel][0];
}

void draw_values(const Study& study) {
  std::vector<Panel> panels;
  for (const int m : {0, 1, 3}) {
    const Medium& medium = study.media[m];
    Panel panel{medium.sample.name,
                "set logscale y\nset yrange [1e-6:1.5]\nset xrange [0:21]\nset format y '10^{%T}'\n"
                "set xlabel 'number of the singular value'\n"
                "set ylabel 'size, relative to the first'"};
    for (int c = 0; c < 3; ++c) {
      Curve curve{channel_names[c], fmt::format("linespoints lc rgb '{}' lw 2 pt 7 ps 0.5", channel_colours[c]), {}};
      for (int i = 0; i < most_values; ++i) {
        // Beyond an exact rank there is only rounding.
        if (relative(medium.svd, c, i) > 1e-10) curve.add(i + 1, relative(medium.svd, c, i));
      }
      panel.curves.push_back(curve);
    }
    panels.push_back(panel);
  }
  draw("--paper", study.folder / "fig2.svg", panels, 3);
}

Claim decay(const Study& study) {
  constexpr int few = 3;
  constexpr double appreciable = 0.01;
  Evidence found;
  for (const Medium& medium : study.media) {
    double next = 0;
    Json numbers;
    for (int c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (int i = 0; i < 8; ++i) values.push_back(relative(medium.svd, c, i));
      numbers[channel_names[c]] = values;
      next = std::max(next, values[few]);
    }
    const std::vector<double> red = numbers["red"];
    found.add(medium.sample.name,
              fmt::format("red 1, {:.2g}, {:.2g}, {:.2g}, {:.2g}, {:.2g}, {:.2g}; 4th at most {:.2g}", red[1], red[2],
                          red[3], red[4], red[5], red[6], next),
              numbers, next < appreciable);
  }
  return found.claim("fig2_decay", "Fig. 2", "only the first few singular values matter",
                     "the 4th is below 1 % of the first in every channel");
}

Claim energy(const Study& study) {
  Evidence found;
  for (const Medium& medium : study.media) {
    std::vector<double> shares;
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd& values = medium.svd.values[c];
      shares.push_back(values[0] * values[0] / values.squaredNorm());
    }
    found.add(medium.sample.name, percents(shares), shares, *std::min_element(shares.begin(), shares.end()) > 0.5);
  }
  return found.claim("sec3_first_value", "Section 3", "most of the kernel's energy is in the first singular value",
                     "over half the sum of squares in every channel", "red, green, blue:");
}

}  // namespace

Claims fig2(const Study& study) {
  draw_values(study);
  return {decay(study), energy(study)};
}

}  // namespace dermis::bench
