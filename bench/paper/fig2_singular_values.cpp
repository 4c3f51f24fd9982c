// Figure 2: how fast singular values fall.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "paper/plot.hpp"
#include "paper/study.hpp"

namespace dermis::bench {

namespace {

constexpr int most_values = 20;
constexpr std::array<const char*, 3> channel_names = {"red", "green", "blue"};

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
                "set ylabel 'size, relative to the first'",
                {}};
    for (int c = 0; c < 3; ++c) {
      Curve curve{channel_names[c], fmt::format("linespoints lc rgb '{}' lw 2 pt 7 ps 0.5", channel_colours[c]), {}};
      for (int i = 0; i < most_values; ++i) {
        // What is left of an exact rank is rounding.
        if (relative(medium.svd, c, i) > 1e-10) curve.points.emplace_back(i + 1, relative(medium.svd, c, i));
      }
      panel.curves.push_back(curve);
    }
    panels.push_back(panel);
  }
  draw(study.folder / "fig2.svg", panels, 3);
}

Claim decay(const Study& study) {
  constexpr int few = 3;
  constexpr double appreciable = 0.01;
  std::vector<std::string> holds_for;
  std::vector<std::string> fails_for;
  std::vector<std::string> texts;
  nlohmann::ordered_json numbers;
  for (const Medium& medium : study.media) {
    double next = 0;
    for (int c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (int i = 0; i < 8; ++i) values.push_back(relative(medium.svd, c, i));
      numbers[medium.sample.name][channel_names[c]] = values;
      next = std::max(next, values[few]);
    }
    const auto& red = numbers[medium.sample.name]["red"];
    texts.push_back(fmt::format("{}: red 1, {:.2g}, {:.2g}, {:.2g}, {:.2g}, {:.2g}, {:.2g}; 4th at most {:.2g}",
                                medium.sample.name, red[1].get<double>(), red[2].get<double>(), red[3].get<double>(),
                                red[4].get<double>(), red[5].get<double>(), red[6].get<double>(), next));
    (next < appreciable ? holds_for : fails_for).push_back(medium.sample.name);
  }
  return {"fig2_decay",
          "Fig. 2",
          "only the first few singular values matter",
          "the 4th is below 1 % of the first in every channel",
          fmt::format("{}", fmt::join(texts, "<br>")),
          verdict_of(holds_for, fails_for),
          numbers};
}

Claim energy(const Study& study) {
  std::vector<std::string> texts;
  nlohmann::ordered_json numbers;
  double least = 1;
  for (const Medium& medium : study.media) {
    std::vector<double> shares;
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd& values = medium.svd.values[c];
      shares.push_back(values[0] * values[0] / values.squaredNorm());
      least = std::min(least, shares.back());
    }
    numbers[medium.sample.name] = shares;
    texts.push_back(fmt::format("{}: {}", medium.sample.name, percents(shares)));
  }
  return {"sec3_first_value",
          "Section 3",
          "most of the kernel's energy is in the first singular value",
          "over half the sum of squares in every channel",
          fmt::format("red, green, blue:<br>{}", fmt::join(texts, "<br>")),
          verdict_of(least > 0.5),
          numbers};
}

}  // namespace

Claims fig2(const Study& study) {
  draw_values(study);
  return {decay(study), energy(study)};
}

}  // namespace dermis::bench
