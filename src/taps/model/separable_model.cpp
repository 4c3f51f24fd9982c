#include "taps/model/separable_model.hpp"

#include <cmath>
#include <numbers>

namespace dermis {

double TermFunction::sum() const {
  double total = marginal_share;
  double size = std::abs(marginal_share);
  for (const Gaussian& gaussian : gaussians) {
    total += gaussian.weight;
    size += std::abs(gaussian.weight);
  }
  // Terms that cancel leave rounding behind, which nothing may scale up.
  constexpr double rounding = 1e-14;
  return std::abs(total) > rounding * size ? total : 0;
}

double value_of(const Profile& profile, int channel, const TermFunction& f, double x_mm) {
  double value = f.marginal_share != 0 ? f.marginal_share * profile.marginal(channel, x_mm) : 0;
  for (const auto& [v, weight] : f.gaussians) {
    value += weight * std::exp(-x_mm * x_mm / (2 * v)) / std::sqrt(2 * std::numbers::pi * v);
  }
  return value;
}

double tail_of(const Profile& profile, int channel, const TermFunction& f, double x_mm) {
  double tail = f.marginal_share != 0 ? f.marginal_share * profile.edge_tail(channel, x_mm) : 0;
  for (const auto& [v, weight] : f.gaussians) tail += weight * std::erfc(x_mm / std::sqrt(2 * v)) / 2;
  return tail;
}

double fitting_pixel_mm(const Profile& profile, int channel) { return profile.half_width(channel, 0.999) / 96; }

std::vector<ModelTerm> make_model(const Profile& profile, const TapsDesign& design) {
  switch (design.model) {
    case Model::pre_integrated: {
      ModelTerm term;
      term.functions.fill({.marginal_share = 1, .gaussians = {}});
      return {term};
    }
    case Model::artist:
      return {merged(fit_gaussians(profile, 2))};
    case Model::guided:
      return fit_guided(profile, design.guide);
    case Model::svd:
      return fit_svd(profile, design.rank);
    case Model::gaussians:
      return fit_gaussians(profile, design.rank);
    case Model::optimised:
      return fit_optimised(profile, design.rank, design.non_negative);
  }
  return {};
}

ModelTerm merged(const std::vector<ModelTerm>& terms) {
  ModelTerm result;
  for (const ModelTerm& term : terms) {
    for (int c = 0; c < 3; ++c) {
      for (const auto& [v, weight] : term.functions[c].gaussians) {
        result.functions[c].gaussians.push_back({v, weight * term.scale[c]});
      }
    }
  }
  return result;
}

}  // namespace dermis
