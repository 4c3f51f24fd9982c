// The functions f of a model: R(sqrt(x^2 + y^2)) ~ sum over terms of scale f(x) f(y).
#pragma once

#include <array>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/taps.hpp"

namespace dermis {

/// A one-dimensional Gaussian: weight exp(-x^2 / (2 v)) / sqrt(2 pi v).
struct Gaussian {
  double variance_mm2;
  double weight;
};

/// f of one term in one channel: so much of the marginal a(x), and Gaussians of either sign.
struct TermFunction {
  double marginal_share = 0;
  std::vector<Gaussian> gaussians;

  /// The integral of f.
  double sum() const;
};

/// One term in all channels.
struct ModelTerm {
  Rgb scale{1, 1, 1};
  bool normalised = true;  ///< f is not negative and integrates to 1
  std::array<TermFunction, 3> functions;
};

/// f(x), 1/mm, and its integral from x_mm to infinity.
double value_of(const Profile& profile, int channel, const TermFunction& f, double x_mm);
double tail_of(const Profile& profile, int channel, const TermFunction& f, double x_mm);

/// The size of a pixel that models are fitted for: the kernel's half-width is 96 of them. Models hardly depend on it.
double fitting_pixel_mm(const Profile& profile, int channel);

/// The terms of a design that is in range.
std::vector<ModelTerm> make_model(const Profile& profile, const TapsDesign& design);

/// One term whose f is the sum of scale f over the terms.
ModelTerm merged(const std::vector<ModelTerm>& terms);

// The models that are fitted, each in a file of its name.
std::vector<ModelTerm> fit_gaussians(const Profile& profile, int count);
std::vector<ModelTerm> fit_guided(const Profile& profile, double guide);
std::vector<ModelTerm> fit_optimised(const Profile& profile, int rank, bool non_negative);
std::vector<ModelTerm> fit_svd(const Profile& profile, int rank);

}  // namespace dermis
