#include "profile/random_walk.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "profile/fresnel.hpp"
#include "profile/walk_table.hpp"

namespace dermis {

namespace {

/// The diffuse albedo of a dipole (Jensen et al. 2001, section 2.4), by s = sqrt(3 (1 - a')).
double dipole_albedo(double s, double four_thirds_a) {
  return (1 - s * s / 3) / 2 * (1 + std::exp(-four_thirds_a * s)) * std::exp(-s);
}

/// a', as coarse as Cycles has it: twelve bisections, which leave it an odd multiple of 2^-12, between two constants.
double reduced_albedo(double albedo) {
  if (albedo < 1e-4) return 0;
  if (albedo >= 0.995) return 0.999999;
  const double reflected = diffuse_fresnel_fit(1.4);
  const double four_thirds_a = 4.0 / 3 * (1 + reflected) / (1 - reflected);
  double middle = 0;
  double low = 0;
  double high = 1;
  for (int i = 0; i < 12; ++i) {
    middle = (low + high) / 2;
    (dipole_albedo(std::sqrt(3 * (1 - middle)), four_thirds_a) < albedo ? low : high) = middle;
  }
  return middle;
}

}  // namespace

double walk_mfp(double radius, double albedo) { return radius * std::sqrt(3 * (1 - reduced_albedo(albedo))); }

double single_scattering_albedo(double albedo) {
  // The constants are those of Cycles for isotropic scattering, and so are the bounds.
  const double high = std::pow(albedo, 0.25);
  const double of_low = 1.8260523782 * std::pow(std::atan(4.98511194385 * albedo), 1.09686102424);
  const double of_high = 0.496310210422 * std::pow(std::atan(4.23190299701 * albedo), 2.40602999408);
  return std::clamp((1 - high) * of_low + high * of_high, 0.2, 0.999999);
}

std::vector<ExponentialCurve::Term> walk_terms(double mfp_mm, double albedo) {
  const double absorbed = 1 - single_scattering_albedo(albedo);
  // A mixture of profiles is a profile. Rows are so close that it is the one between.
  std::size_t row = 1;
  while (row + 1 < walk_table.size() && walk_table[row].absorbed > absorbed) ++row;
  const WalkRow& more = walk_table[row - 1];
  const WalkRow& less = walk_table[row];
  const double t = std::clamp((more.absorbed - absorbed) / (more.absorbed - less.absorbed), 0.0, 1.0);
  std::vector<ExponentialCurve::Term> terms;
  double all = 0;
  for (std::size_t i = 0; i < walk_lengths.size(); ++i) {
    const double weight = (1 - t) * more.weight[i] + t * less.weight[i];
    if (weight > 0) terms.push_back({weight, walk_lengths[i] * mfp_mm});
    all += weight;
  }
  for (ExponentialCurve::Term& term : terms) term.weight /= all;
  return terms;
}

}  // namespace dermis
