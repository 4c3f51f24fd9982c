// A profile as two products of sums of exponentials.
#include <Eigen/Core>
#include <cmath>
#include <string>

#include "dermis/error.hpp"
#include "dermis/texture.hpp"
#include "taps/model/least_squares.hpp"
#include "taps/model/plane_spectrum.hpp"
#include "taps/model/separable_model.hpp"
#include "taps/prediction/expected_error.hpp"
#include "texture/pole_spectrum.hpp"

namespace dermis {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd spectrum_of(const TermFunction& f, const VectorXd& marginal, const VectorXd& squared_omega) {
  VectorXd sum = f.marginal_share * marginal;
  for (const Gaussian& gaussian : f.gaussians) {
    sum.array() += gaussian.weight * (-gaussian.variance_mm2 / 2 * squared_omega.array()).exp();
  }
  return sum;
}

/// The weight of a function's error along one axis, if the function along the other axis is `f`.
VectorXd axis_weight(const PlaneSpectrum& plane, const VectorXd& f) {
  const MatrixXd weighted = plane.weight * f.cwiseAbs2().asDiagonal() * plane.weight.transpose();
  return weighted.diagonal().cwiseSqrt();
}

struct FittedChannel {
  Recursion::Function main, correction;
  double squared_error, truth_power;
};

/// The functions of the model first, each by itself, then both together against the profile.
FittedChannel fit_channel(const Profile& profile, int channel, const std::vector<ModelTerm>& model) {
  const PlaneSpectrum plane(profile, channel);
  const VectorXd squared_omega = plane.omega_per_mm().cwiseAbs2();
  const VectorXd marginal = plane.truth.col(0);
  const PoleSpectrum main(1);
  const PoleSpectrum correction(0);
  const double scale = 1 / std::sqrt(profile.half_width(channel, 0.5) * profile.half_width(channel, 0.95));
  const auto fit = [&](const PoleSpectrum& poles, std::size_t term) {
    const VectorXd f = spectrum_of(model[term].functions[channel], marginal, squared_omega);
    return poles.fit(squared_omega, f, axis_weight(plane, f), scale);
  };
  constexpr int n = PoleSpectrum::unknowns;
  const double sign = model[1].scale[channel] < 0 ? -1 : 1;
  VectorXd x(2 * n);
  x << fit(main, 0), fit(correction, 1);
  const auto products = [&](const VectorXd& parameters) -> MatrixXd {
    const VectorXd f = main.values(parameters.head(n), squared_omega);
    const VectorXd h = correction.values(parameters.tail(n), squared_omega);
    return f * f.transpose() + sign * h * h.transpose();
  };
  least_squares(
      x,
      [&](const VectorXd& parameters) -> VectorXd {
        const MatrixXd off = plane.weight.cwiseProduct(products(parameters) - plane.truth);
        return off.reshaped();
      },
      400);
  return {main.function(x.head(n)), correction.function(x.tail(n)), plane.squared_error(products(x)),
          plane.truth_power()};
}

}  // namespace

Recursion make_recursion(const Profile& profile) {
  const std::vector<ModelTerm> model = make_model(profile, {.rank = 2});
  Recursion recursion;
  std::array<double, 3> errors{};
  std::array<double, 3> powers{};
  for (int c = 0; c < 3; ++c) {
    const FittedChannel fitted = fit_channel(profile, c, model);
    recursion.main[c] = fitted.main;
    recursion.correction[c] = fitted.correction;
    recursion.sign[c] = model[1].scale[c] < 0 ? -1 : 1;
    errors[c] = fitted.squared_error;
    powers[c] = fitted.truth_power;
  }
  recursion.predicted_rel_l2 = relative_l2(errors, powers);
  if (!(recursion.predicted_rel_l2 <= Recursion::worst_rel_l2)) {
    throw Error(
        ErrorCode::usage, "profile", "one that recursion is off by " + std::to_string(recursion.predicted_rel_l2),
        "one that four exponentials follow within " + std::to_string(Recursion::worst_rel_l2) + ", or another method");
  }
  return recursion;
}

}  // namespace dermis
