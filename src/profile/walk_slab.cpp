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

double half_space_light(double scattering_albedo) {
  // What comes through a thick slab is diffuse as what falls on it, so that a half-space is that slab on a half-space.
  const auto [transmitted, returned] = slab_light(30, scattering_albedo);
  double all = returned;
  for (int i = 0; i < 1000; ++i) all = returned + transmitted * transmitted * all / (1 - returned * all);
  return std::min(all, 1.0);
}

}  // namespace dermis
