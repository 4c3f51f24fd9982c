#include "profile/walk_slab.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "profile/quadrature.hpp"

namespace dermis {

namespace {

constexpr int nodes = 32;
using Matrix = Eigen::Matrix<double, nodes, nodes>;
using Vector = Eigen::Matrix<double, nodes, 1>;

/// Exponential integrals of the orders 1, 2 and 3.
double e1(double x) { return -std::expint(-x); }
double e2(double x) { return x > 0 ? std::exp(-x) - x * e1(x) : 1; }
double e3(double x) { return (std::exp(-x) - x * e2(x)) / 2; }

/// Depths and weights that are dense at both faces, where the light changes fastest: t = h (3 s^2 - 2 s^3).
struct Depths {
  std::array<double, nodes> depth;
  std::array<double, nodes> weight;
};

Depths depths_in(double thickness) {
  static const GaussLegendre<nodes> rule;
  Depths result{};
  for (int i = 0; i < nodes; ++i) {
    const double s = (1 + rule.point[i]) / 2;
    result.depth[i] = thickness * s * s * (3 - 2 * s);
    result.weight[i] = rule.weight[i] / 2 * thickness * 6 * s * (1 - s);
  }
  return result;
}

}  // namespace

// Of the light that enters, 2 E3(t) is left unscattered at the depth t, so that 2 E2(t) scatters first there. What has
// scattered at t' scatters next at t with the density a E1(|t - t'|) / 2, and leaves through a face at the distance s
// with the chance a E2(s) / 2. So the scatterings C(t) are (Chandrasekhar 1960, Radiative Transfer, section 11)
//     C(t) = 2 E2(t) + a / 2 integral of E1(|t - t'|) C(t') dt'.
// E1 has a pole at 0: the quadrature integrates C(t') - C(t), and E1 alone is 2 - E2(t) - E2(h - t).
SlabLight slab_light(double thickness, double scattering_albedo) {
  const double half = scattering_albedo / 2;
  const Depths at = depths_in(thickness);
  Matrix matrix = Matrix::Zero();
  Vector first;
  for (int i = 0; i < nodes; ++i) {
    const double depth = at.depth[i];
    first(i) = 2 * e2(depth);
    matrix(i, i) += 1 - half * (2 - e2(depth) - e2(thickness - depth));
    for (int j = 0; j < nodes; ++j) {
      if (i == j) continue;
      const double weight = half * at.weight[j] * e1(std::abs(depth - at.depth[j]));
      matrix(i, j) -= weight;
      matrix(i, i) += weight;
    }
  }
  const Vector scatterings = matrix.partialPivLu().solve(first);
  SlabLight light{2 * e3(thickness), 0};
  for (int i = 0; i < nodes; ++i) {
    light.transmitted += half * at.weight[i] * scatterings(i) * e2(thickness - at.depth[i]);
    light.returned += half * at.weight[i] * scatterings(i) * e2(at.depth[i]);
  }
  return light;
}

// By Chandrasekhar's H function (sections 35 and 38), 1 / H(m) = s + a / 2 integral of n H(n) / (m + n) dn with
// s = sqrt(1 - a): a beam returns 1 - s H(m), and light that falls from all sides the mean of that by the cosine law.
double half_space_light(double scattering_albedo) {
  static const GaussLegendre<nodes> rule;
  constexpr int iterations = 60;
  const double root = std::sqrt(1 - scattering_albedo);
  std::array<double, nodes> h{};
  h.fill(1);
  for (int i = 0; i < iterations; ++i) {
    std::array<double, nodes> next{};
    for (int m = 0; m < nodes; ++m) {
      double integral = 0;
      for (int n = 0; n < nodes; ++n) {
        integral += rule.weight[n] / 2 * (1 + rule.point[n]) * h[n] / (2 + rule.point[m] + rule.point[n]);
      }
      // Half of the step: the whole one goes to and fro where nearly nothing is absorbed.
      next[m] = (h[m] + 1 / (root + scattering_albedo / 2 * integral)) / 2;
    }
    h = next;
  }
  double lost = 0;
  for (int n = 0; n < nodes; ++n) lost += rule.weight[n] / 2 * (1 + rule.point[n]) * h[n];
  return 1 - root * lost;
}

}  // namespace dermis
