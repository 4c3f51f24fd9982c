// A profile as six Gaussians.
#include <Eigen/Core>

#include "dermis/texture.hpp"
#include "taps/model/plane_spectrum.hpp"
#include "taps/model/separable_model.hpp"
#include "taps/prediction/expected_error.hpp"

namespace dermis {

GaussianChain make_gaussian_chain(const Profile& profile) {
  constexpr int levels = 6;
  const std::vector<ModelTerm> terms = make_model(profile, {.model = Model::gaussians, .rank = levels});
  GaussianChain chain;
  std::array<double, 3> errors{};
  std::array<double, 3> powers{};
  for (int c = 0; c < 3; ++c) {
    const PlaneSpectrum plane(profile, c);
    const Eigen::VectorXd squared_omega = plane.omega_per_mm().cwiseAbs2();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(plane.truth.rows(), plane.truth.cols());
    for (const ModelTerm& term : terms) {
      const double variance_mm2 = term.functions[c].gaussians.front().variance_mm2;
      chain.variances_mm2[c].push_back(variance_mm2);
      chain.weights[c].push_back(term.scale[c]);
      const Eigen::VectorXd f = (-variance_mm2 / 2 * squared_omega.array()).exp();
      sum += term.scale[c] * f * f.transpose();
    }
    errors[c] = plane.squared_error(sum);
    powers[c] = plane.truth_power();
  }
  chain.predicted_rel_l2 = relative_l2(errors, powers);
  return chain;
}

}  // namespace dermis
