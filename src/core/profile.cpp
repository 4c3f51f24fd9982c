#include "dermis/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "dermis/error.hpp"

namespace dermis {

namespace {

constexpr double pi = std::numbers::pi;

/// K0(z) and its integral from z to infinity, z > 0, from K0(z) = integral over u > 0 of exp(-z cosh u). The trapezoid
/// rule with step h is off by exp(-pi^2 / h), 4e-22 here, because the integrand is analytic for |Im u| < pi / 2.
struct BesselK0 {
  double value = 0;
  double tail = 0;

  explicit BesselK0(double z) {
    constexpr double step = 0.2;
    constexpr double negligible_exponent = 42;  // exp(-42) is below the double precision of the sum
    for (const double c : cosines()) {
      if (z * (c - 1) > negligible_exponent) break;
      const double term = std::exp(-z * c);
      const double half = c == 1 ? 0.5 : 1;
      value += half * term;
      tail += half * term / c;
    }
    value *= step;
    tail *= step;
  }

 private:
  static const std::vector<double>& cosines() {
    static const std::vector<double> values = [] {
      std::vector<double> c(400);
      for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::cosh(0.2 * static_cast<double>(i));
      return c;
    }();
    return values;
  }
};

double burley_radius(double d_mm, double share) {
  // y = exp(-r / 3d) solves y^3 + 3y = 4 (1 - u). Near u = 0 y is nearly 1, so 1 - y is computed instead.
  const double b = 2 * (1 - share);
  if (share >= 0.5) return -3 * d_mm * std::log(2 * std::sinh(std::asinh(b) / 3));
  const double t0 = std::asinh(2.0) / 3;
  const double dt = std::asinh(4 * share * (2 - share) / (2 * std::sqrt(1 + b * b) + std::sqrt(5.0) * b)) /
                    3;  // (asinh 2 - asinh b) / 3
  const double one_minus_y = 4 * std::cosh(t0 - dt / 2) * std::sinh(dt / 2);
  return -3 * d_mm * std::log1p(-one_minus_y);
}

/// The x > 0 at which the decreasing function f falls to `target`.
template <class Function>
double solve_decreasing(const Function& f, double target, double start) {
  double low = 0;
  double high = start;
  while (f(high) > target && std::isfinite(high)) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) > target ? low : high) = middle;
  }
  return (low + high) / 2;
}

void require_share(double share) {
  if (!(share >= 0 && share < 1)) throw Error(ErrorCode::usage, "share", std::to_string(share), "0 <= share < 1");
}

// What float32 squares of it, and of its reciprocal, can hold with room to spare.
constexpr double shortest_mm = 1e-9;
constexpr double longest_mm = 1e9;

std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void require_lengths(const Rgb& values, const char* argument) {
  for (const double value : values) {
    if (!(value >= shortest_mm && value <= longest_mm)) {
      throw Error(ErrorCode::usage, argument, number_text(value), "1e-9..1e9 mm per channel");
    }
  }
}

/// Christensen and Burley 2015, eq. 6.
double shape_factor(double albedo) { return 1.9 - albedo + 3.5 * (albedo - 0.8) * (albedo - 0.8); }

}  // namespace

Profile Profile::burley(const Rgb& d_mm) {
  require_lengths(d_mm, "d_mm");
  Profile profile;
  profile.burley_d_mm_ = d_mm;
  return profile;
}

Profile Profile::burley_cycles(const Rgb& radius_mm, const Rgb& albedo) {
  require_lengths(radius_mm, "radius_mm");
  Rgb d_mm;
  for (int c = 0; c < 3; ++c) {
    if (!(albedo[c] >= 0 && albedo[c] <= 1)) {
      throw Error(ErrorCode::usage, "albedo", std::to_string(albedo[c]), "0..1 per channel");
    }
    d_mm[c] = radius_mm[c] / (4 * pi) / shape_factor(albedo[c]);
  }
  return burley(d_mm);
}

Profile Profile::burley_cycles(const Rgb& radius_mm) {
  require_lengths(radius_mm, "radius_mm");
  Profile profile = burley({radius_mm[0] / (4 * pi), radius_mm[1] / (4 * pi), radius_mm[2] / (4 * pi)});
  profile.width_follows_albedo_ = true;
  return profile;
}

Profile Profile::gaussians(const std::vector<GaussianTerm>& terms) {
  Rgb total{};
  for (const GaussianTerm& term : terms) {
    if (!(term.variance_mm2 >= shortest_mm * shortest_mm && term.variance_mm2 <= longest_mm * longest_mm)) {
      throw Error(ErrorCode::usage, "variance_mm2", number_text(term.variance_mm2), "1e-18..1e18 mm^2");
    }
    for (int c = 0; c < 3; ++c) {
      if (!(term.weight[c] >= 0 && std::isfinite(term.weight[c]))) {
        throw Error(ErrorCode::usage, "weight", std::to_string(term.weight[c]), "0 or more per channel");
      }
      total[c] += term.weight[c];
    }
  }
  Profile profile;
  for (int c = 0; c < 3; ++c) {
    if (!(total[c] > 0 && std::isfinite(total[c]))) {
      throw Error(ErrorCode::usage, "weight", "a sum of " + number_text(total[c]),
                  "a positive, finite sum in every channel");
    }
    for (const GaussianTerm& term : terms) {
      if (term.weight[c] > 0) profile.gaussians_[c].push_back({term.weight[c] / total[c], term.variance_mm2});
    }
  }
  return profile;
}

double Profile::radial(int channel, double r_mm) const {
  if (gaussians_[channel].empty()) {
    const double s = 1 / burley_d_mm_[channel];
    return s * (std::exp(-s * r_mm) + std::exp(-s * r_mm / 3)) / (8 * pi * r_mm);
  }
  double sum = 0;
  for (const auto& [weight, v] : gaussians_[channel]) sum += weight * std::exp(-r_mm * r_mm / (2 * v)) / (2 * pi * v);
  return sum;
}

double Profile::marginal(int channel, double x_mm) const {
  const double x = std::abs(x_mm);
  if (gaussians_[channel].empty()) {
    const double s = 1 / burley_d_mm_[channel];
    return s / (4 * pi) * (BesselK0(s * x).value + BesselK0(s * x / 3).value);
  }
  double sum = 0;
  for (const auto& [weight, v] : gaussians_[channel])
    sum += weight * std::exp(-x * x / (2 * v)) / std::sqrt(2 * pi * v);
  return sum;
}

double Profile::edge(int channel, double x_mm) const { return edge_tail(channel, -x_mm); }

double Profile::edge_tail(int channel, double x_mm) const {
  if (x_mm < 0) return 1 - edge_tail(channel, -x_mm);
  if (x_mm == 0) return 0.5;
  if (gaussians_[channel].empty()) {
    const double s = 1 / burley_d_mm_[channel];
    return (BesselK0(s * x_mm).tail + 3 * BesselK0(s * x_mm / 3).tail) / (4 * pi);
  }
  double sum = 0;
  for (const auto& [weight, v] : gaussians_[channel]) sum += weight * std::erfc(x_mm / std::sqrt(2 * v)) / 2;
  return sum;
}

double Profile::cdf(int channel, double r_mm) const {
  if (gaussians_[channel].empty()) {
    const double s = 1 / burley_d_mm_[channel];
    return -std::expm1(-s * r_mm) / 4 - 3 * std::expm1(-s * r_mm / 3) / 4;
  }
  double sum = 0;
  for (const auto& [weight, v] : gaussians_[channel]) sum -= weight * std::expm1(-r_mm * r_mm / (2 * v));
  return sum;
}

double Profile::radius(int channel, double share) const {
  require_share(share);
  if (gaussians_[channel].empty()) return burley_radius(burley_d_mm_[channel], share);
  if (share == 0) return 0;
  const double widest = std::sqrt(gaussians_[channel].back().variance_mm2);
  return solve_decreasing([&](double r) { return -cdf(channel, r); }, -share, widest);
}

double Profile::half_width(int channel, double share) const {
  require_share(share);
  if (share == 0) return 0;
  return solve_decreasing([&](double x) { return 2 * edge_tail(channel, x); }, 1 - share, radius(channel, share));
}

int Profile::widest_channel() const {
  constexpr double share = 0.95;
  int widest = 0;
  for (int c = 1; c < 3; ++c) {
    if (half_width(c, share) > half_width(widest, share)) widest = c;
  }
  return widest;
}

double Profile::width_at(double albedo) const {
  return width_follows_albedo_ ? 1 / shape_factor(std::clamp(albedo, 0.0, 1.0)) : 1;
}

}  // namespace dermis
