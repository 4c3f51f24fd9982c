// Figure 7: a step of light.
#include <fmt/format.h>

#include <algorithm>

#include "paper/step_response.hpp"
#include "paper/study.hpp"
#include "report/panel.hpp"

namespace dermis::bench {

namespace {

constexpr int most_terms = 6;
constexpr double range_mm = 4;  // on both sides of the step

/// Largest errors of 1 to most_terms terms.
struct ErrorsByTerms {
  std::vector<double> gaussians;
  std::vector<double> svd;
  std::vector<double> svd_renormalised;
};

ErrorsByTerms errors_by_terms(const Medium& medium) {
  ErrorsByTerms errors;
  for (int terms = 1; terms <= most_terms; ++terms) {
    errors.gaussians.push_back(max_step_error(dense_model(medium.sample, Model::gaussians, terms), medium.sample));
    errors.svd.push_back(max_step_error(medium.svd.truncated(terms), medium.sample));
    errors.svd_renormalised.push_back(max_step_error(medium.svd.renormalised(terms), medium.sample));
  }
  return errors;
}

struct NamedKernel {
  std::string title;
  const char* colour;
  Products products;
};

/// Light in red over distance, or its error in percent of the step.
Curve curve_of(const std::string& title, const std::string& style, const Eigen::VectorXd& values, double factor,
               double pixel_mm) {
  Curve curve{title, style, {}};
  // Pixel 0 is the first lit one; its centre lies half a pixel inside.
  for (int i = 0; i < side_px; ++i) curve.add((i - half_px + 0.5) * pixel_mm, factor * values[i]);
  return curve;
}

void draw_steps(const Study& study, const ErrorsByTerms& errors) {
  const Sample& sample = study.skin().sample;
  const StepResponses truth = step_responses(sample);
  const std::vector<NamedKernel> all = {{"1 Gaussian", colours[1], dense_model(sample, Model::gaussians, 1)},
                                        {"2 Gaussians", colours[4], dense_model(sample, Model::gaussians, 2)},
                                        {"close fit", colours[3], artist_preset("artist-close-fit", sample.pixel_mm)},
                                        {"production", colours[0], artist_preset("artist-production", sample.pixel_mm)},
                                        {"pre-integrated", colours[2], study.skin().rank_1}};
  const std::string x_range = fmt::format("set xrange [{}:{}]\n", -range_mm, range_mm);
  Panel steps{"skin, red: a step of light",
              x_range +
                  "set yrange [-0.02:1.02]\nset xlabel 'distance from the step, mm'\n"
                  "set ylabel 'light'\nset key bottom right noreverse Right",
              {curve_of("exact", "lines lc rgb '#999999' lw 6", truth[0], 1, sample.pixel_mm)}};
  Panel off{"how far off", x_range +
                               "set yrange [-10:24]\nset xlabel 'distance from the step, mm'\n"
                               "set ylabel 'error, % of the step'\nset key top left"};
  for (const NamedKernel& named : all) {
    const StepResponses seen = step_responses(named.products);
    const std::string style = fmt::format("lines lc rgb '{}' lw 2", named.colour);
    if (named.title != "2 Gaussians") {
      steps.curves.push_back(curve_of(named.title, style, seen[0], 1, sample.pixel_mm));
    }
    off.curves.push_back(curve_of(named.title, style, seen[0] - truth[0], 100, sample.pixel_mm));
  }

  Panel terms{"skin: largest error over the number of terms",
              "set logscale y\nset yrange [1e-6:1]\nset xrange [0.8:6.2]\nset xtics 1\nset format y '10^{%T}'\n"
              "set xlabel 'terms (two convolutions each)'\nset ylabel 'largest error, of the step'\n"
              "set key bottom left"};
  const auto add = [&](const char* title, const char* style, const std::vector<double>& values) {
    Curve curve{title, style, {}};
    for (int i = 0; i < most_terms; ++i) curve.add(i + 1, values[i]);
    terms.curves.push_back(curve);
  };
  add("Gaussians", "linespoints lc rgb '#e08e1b' lw 2 pt 7 ps 0.6", errors.gaussians);
  add("SVD", "linespoints lc rgb '#2f6db5' lw 2 pt 7 ps 0.6", errors.svd);
  add("SVD, scaled to keep all light", "linespoints lc rgb '#2f6db5' lw 2 dt 2 pt 6 ps 0.6", errors.svd_renormalised);
  draw("--paper", study.folder / "fig7.svg", {steps, off, terms}, 3);
}

Claim exact_on_axes(const Study& study) {
  constexpr double rounding = 1e-8;  // the profile's integrals are no more accurate
  Evidence found;
  for (const Medium& medium : study.media) {
    const double error = max_step_error(medium.rank_1, medium.sample);
    found.add(medium.sample.name, fmt::format("{:.1e}", error), error, error <= rounding);
  }
  return found.claim("fig7_pre_integrated", "Fig. 7, eq. 4", "pre-integration is exact for a step along an axis",
                     "largest error at most 1e-8 of the step, the accuracy of the integrals", "largest error:");
}

Claim several_needed(const Study& study, const ErrorsByTerms& skin) {
  const auto needed = [](const std::vector<double>& errors) {
    const auto first = std::find_if(errors.begin(), errors.end(), [](double error) { return error <= good_enough; });
    return static_cast<int>(first - errors.begin()) + 1;
  };
  Evidence found;
  for (const auto& [name, errors] :
       {std::pair{"skin", skin}, std::pair{"skin-measured", errors_by_terms(study.media[1])}}) {
    found.add(name,
              fmt::format("Gaussians {}; SVD {}; scaled {}", percents(errors.gaussians), percents(errors.svd),
                          percents(errors.svd_renormalised)),
              {{"gaussians", errors.gaussians}, {"svd", errors.svd}, {"svd_renormalised", errors.svd_renormalised}},
              needed(errors.gaussians) > 1 && needed(errors.svd) > 1 && needed(errors.svd_renormalised) > 1);
  }
  return found.claim("fig7_several_terms", "Fig. 7", "sums of Gaussians and SVD need several terms on a step",
                     "more than one until the largest error is at most 1 % of the step", "1 to 6 terms:");
}

Claim two_convolutions(const Study& study) {
  Evidence found;
  for (const Medium& medium : study.media) {
    const Products gaussian = dense_model(medium.sample, Model::gaussians, 1);
    const double natural = study.natural.rel_l2(medium.rank_1, medium.sample);
    const double natural_gaussian = study.natural.rel_l2(gaussian, medium.sample);
    const double dot = study.dot.rel_l2(medium.rank_1, medium.sample);
    const double dot_gaussian = study.dot.rel_l2(gaussian, medium.sample);
    found.add(
        medium.sample.name,
        fmt::format("natural {} against {}, dot {} against {}", percent(natural), percent(natural_gaussian),
                    percent(dot), percent(dot_gaussian)),
        {{"natural", natural}, {"natural_gaussian", natural_gaussian}, {"dot", dot}, {"dot_gaussian", dot_gaussian}},
        natural < natural_gaussian);
  }
  return found.claim("table1_two_convolutions", "Table 1, Fig. 13",
                     "with two convolutions, pre-integration does better than one Gaussian",
                     "closer on natural pictures");
}

}  // namespace

Claims fig7(const Study& study) {
  const ErrorsByTerms errors = errors_by_terms(study.skin());
  draw_steps(study, errors);
  return {exact_on_axes(study), several_needed(study, errors), two_convolutions(study)};
}

}  // namespace dermis::bench
