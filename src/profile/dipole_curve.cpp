#include "profile/dipole_curve.hpp"

#include <cmath>
#include <numbers>

#include "profile/fresnel.hpp"

namespace dermis {

namespace {

using std::numbers::pi;

/// z (1 + s d) e^(-s d) / d^3
double flux_of(double z, double s, double d) { return z * (1 + s * d) * std::exp(-s * d) / (d * d * d); }

/// The integral of flux_of / 2 pi over the disc of radius r: e^(-s z) - z e^(-s d) / d with d - z = r^2 / (d + z).
double flux_within(double z, double s, double r) {
  const double ratio = r / z;
  const double d = std::sqrt(r * r + z * z);
  return -std::exp(-s * z) * std::expm1(-s * r * r / (d + z) - std::log1p(ratio * ratio) / 2);
}

/// The integral of e^(-s d) / d / 2 pi over the disc of radius r.
double fluence_within(double z, double s, double r) {
  const double d = std::sqrt(r * r + z * z);
  return -std::exp(-s * z) * std::expm1(-s * r * r / (d + z)) / s;
}

}  // namespace

DipoleCurve::DipoleCurve(const Sources& sources)
    : s_(sources.s),
      z_r_(sources.real_depth),
      z_v_(sources.virtual_height),
      flux_(sources.flux),
      fluence_(sources.fluence) {
  const double all = disc_tail(0);
  flux_ /= all;
  fluence_ /= all;
}

DipoleCurve::Sources DipoleCurve::classical(const Medium& medium) {
  const double extinction = medium.reduced_scattering + medium.absorption;
  const double depth = 1 / extinction;
  const double reflected = diffuse_fresnel_fit(medium.eta);
  const double a = (1 + reflected) / (1 - reflected);
  return {.s = std::sqrt(3 * medium.absorption * extinction),
          .real_depth = depth,
          .virtual_height = depth * (1 + 4 * a / 3),
          .flux = 1,
          .fluence = 0};
}

DipoleCurve::Sources DipoleCurve::better(const Medium& medium) {
  const double extinction = medium.reduced_scattering + medium.absorption;
  const double depth = 1 / extinction;
  const double diffusion = (2 * medium.absorption + medium.reduced_scattering) / (3 * extinction * extinction);
  const auto [c1, c2] = fresnel_moments(medium.eta);
  const double a = (1 + 3 * c2) / (1 - 2 * c1);
  return {.s = std::sqrt(medium.absorption / diffusion),
          .real_depth = depth,
          .virtual_height = depth + 4 * a * diffusion,
          .flux = (1 - 3 * c2) / 2,
          .fluence = (1 - 2 * c1) / (4 * diffusion)};
}

double DipoleCurve::radial(double r) const {
  const double d_r = std::sqrt(r * r + z_r_ * z_r_);
  const double d_v = std::sqrt(r * r + z_v_ * z_v_);
  double sum = flux_ * (flux_of(z_r_, s_, d_r) + flux_of(z_v_, s_, d_v));
  if (fluence_ > 0) {
    const double apart = (z_v_ - z_r_) * (z_v_ + z_r_);  // d_v^2 - d_r^2
    const double less = -std::expm1(-s_ * apart / (d_v + d_r) - std::log1p(apart / (d_r * d_r)) / 2);
    sum += fluence_ * std::exp(-s_ * d_r) / d_r * less;
  }
  return sum;
}

double DipoleCurve::disc(double r) const {
  const double outside = disc_tail(r);
  if (outside < 0.5) return 1 - outside;
  double sum = flux_ * (flux_within(z_r_, s_, r) + flux_within(z_v_, s_, r));
  if (fluence_ > 0) sum += fluence_ * (fluence_within(z_r_, s_, r) - fluence_within(z_v_, s_, r));
  return 2 * pi * sum;
}

double DipoleCurve::disc_tail(double r) const {
  const double d_r = std::sqrt(r * r + z_r_ * z_r_);
  const double d_v = std::sqrt(r * r + z_v_ * z_v_);
  const double decay_r = std::exp(-s_ * d_r);
  double sum = flux_ * (z_r_ * decay_r / d_r + z_v_ * std::exp(-s_ * d_v) / d_v);
  if (fluence_ > 0) {
    const double apart = (z_v_ - z_r_) * (z_v_ + z_r_);
    sum -= fluence_ / s_ * decay_r * std::expm1(-s_ * apart / (d_v + d_r));
  }
  return 2 * pi * sum;
}

double DipoleCurve::spectrum(double omega) const {
  const double q = std::hypot(s_, omega);
  const double real = std::exp(-z_r_ * q);
  double sum = flux_ * (real + std::exp(-z_v_ * q));
  if (fluence_ > 0) sum -= fluence_ / q * real * std::expm1(-(z_v_ - z_r_) * q);
  return 2 * pi * sum;
}

}  // namespace dermis
