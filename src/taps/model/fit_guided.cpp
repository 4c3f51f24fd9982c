// The guided model: Jimenez et al. 2015, Appendix A.
#include <cmath>

#include "taps/model/correction_basis.hpp"
#include "taps/model/product_fit.hpp"
#include "taps/model/separable_model.hpp"

namespace dermis {

namespace {

using Eigen::VectorXd;

/// b of eq. 8, which the paper gives without a unit; 1/mm^2 here.
constexpr double suppression_per_mm2 = 50;

}  // namespace

std::vector<ModelTerm> fit_guided(const Profile& profile, double guide) {
  ModelTerm term;
  for (int c = 0; c < 3; ++c) {
    constexpr int n = 44;
    const double far_mm = profile.half_width(c, 0.999) * 1.5;
    const double near_mm = far_mm * 1e-3;
    const double step = std::log(far_mm / near_mm) / (n - 1);
    const CorrectionBasis basis(profile, c);
    VectorXd x_mm(n);
    VectorXd a(n);
    for (int i = 0; i < n; ++i) {
      x_mm[i] = near_mm * std::exp(step * i);
      a[i] = profile.marginal(c, x_mm[i]);
    }
    ProductFit fit;
    fit.truth.resize(n, n);
    fit.weight.resize(n, n);
    const auto away_from_axis = [&](double x) { return -std::expm1(-suppression_per_mm2 * x * x); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double r_mm = std::hypot(x_mm[i], x_mm[j]);
        const double gamma = std::pow(r_mm, guide) * away_from_axis(x_mm[i]) * away_from_axis(x_mm[j]);
        const double both = i == j ? 1 : 2;
        fit.truth(i, j) = profile.radial(c, r_mm);
        fit.weight(i, j) = std::sqrt(both * gamma * x_mm[i] * x_mm[j]) * step;
      }
    }
    // The sum of squares means nothing but to itself: bring it to the size of 1.
    fit.weight /= (fit.weight.array() * fit.truth.array()).matrix().norm();
    fit.basis = basis.values(x_mm);
    fit.products.push_back({1, a, VectorXd::Zero(basis.size())});
    fit.solve();
    term.functions[c] = basis.function(1, fit.products[0].coefficients);
  }
  return {term};
}

}  // namespace dermis
