// Appendix A: the guided kernel.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "paper/study.hpp"

namespace dermis::bench {

namespace {

constexpr std::array<double, 3> guides = {0, 2, 4};

/// The kernel for each of `guides`.
struct Guided {
  std::vector<double> deviation_mm;   ///< along an axis, of the widest channel
  std::vector<double> half_light_mm;  ///< half-width of the strip that holds half of the channel's light
  std::vector<double> natural;
};

double deviation_px(const Eigen::VectorXd& row) {
  double variance = 0;
  for (int x = 0; x < half_px; ++x) variance += 2.0 * x * x * row[x];
  return std::sqrt(variance / sum_of(row));
}

double half_light_px(const Eigen::VectorXd& row) {
  double within = row[0];
  int x = 0;
  while (within < 0.5 * sum_of(row)) within += 2 * row[++x];
  // Light lies evenly within a pixel.
  const double share_of_last = (within - 0.5 * sum_of(row)) / (x == 0 ? row[0] : 2 * row[x]);
  return x == 0 ? 0.5 * (1 - share_of_last) : x + 0.5 - share_of_last;
}

Guided guided_of(const Study& study, const Sample& sample) {
  Guided result;
  const int channel = sample.profile.widest_channel();
  for (const double guide : guides) {
    const Products products = dense_model(sample, Model::guided, 1, guide);
    const Eigen::VectorXd& row = products[channel][0].f;
    result.deviation_mm.push_back(deviation_px(row) * sample.pixel_mm);
    result.half_light_mm.push_back(half_light_px(row) * sample.pixel_mm);
    result.natural.push_back(study.natural.rel_l2(products, sample));
  }
  return result;
}

bool rises(const std::vector<double>& values) { return values[0] < values[1] && values[1] < values[2]; }

}  // namespace

Claims guided(const Study& study) {
  Evidence widths, closeness;
  for (const Medium& medium : study.media) {
    const Sample& sample = medium.sample;
    const Guided kernels = guided_of(study, sample);
    const Eigen::VectorXd& truth = medium.rank_1[sample.profile.widest_channel()][0].f;
    const double true_deviation_mm = deviation_px(truth) * sample.pixel_mm;
    const double true_half_light_mm = half_light_px(truth) * sample.pixel_mm;
    const double rank_1 = study.natural.rel_l2(medium.rank_1, sample);
    widths.add(sample.name,
               fmt::format("half within {:.2g} mm (exact {:.2g}), standard deviation {:.3g} mm (exact {:.3g})",
                           fmt::join(kernels.half_light_mm, ", "), true_half_light_mm,
                           fmt::join(kernels.deviation_mm, ", "), true_deviation_mm),
               {{"deviation_mm", kernels.deviation_mm},
                {"true_deviation_mm", true_deviation_mm},
                {"half_light_mm", kernels.half_light_mm},
                {"true_half_light_mm", true_half_light_mm}},
               rises(kernels.half_light_mm));
    closeness.add(sample.name, fmt::format("{}, pre-integrated {}", percents(kernels.natural), percent(rank_1)),
                  {{"natural", kernels.natural}, {"natural_pre_integrated", rank_1}},
                  kernels.natural[1] < kernels.natural[0] && kernels.natural[1] < kernels.natural[2]);
  }
  return {widths.claim("appendix_widths", "Appendix A", "guided kernels: k = 0 is sharper than k = 2, k = 4 smoother",
                       "the strip with half of the light widens with k (b = 50, read as 1/mm²)",
                       "k = 0, 2, 4, widest channel:"),
          closeness.claim("appendix_k2", "Appendix A", "k = 2 is near the true kernel",
                          "nearer than k = 0 and k = 4 on natural pictures", "k = 0, 2, 4:")};
}

}  // namespace dermis::bench
