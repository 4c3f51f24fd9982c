#include "profile/gaussian_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace dermis {

namespace {

using std::numbers::pi;

/// The normal distribution's light on from..to, in standard deviations.
double normal_strip(double from, double to) {
  if (to <= 0) return normal_strip(-to, -from);
  if (from < 0.5) return (std::erf(to / std::numbers::sqrt2) - std::erf(from / std::numbers::sqrt2)) / 2;
  return (std::erfc(from / std::numbers::sqrt2) - std::erfc(to / std::numbers::sqrt2)) / 2;
}

template <class Function>
double sum_over(const std::vector<GaussianCurve::Term>& terms, const Function& f) {
  double sum = 0;
  for (const auto& [weight, variance] : terms) sum += weight * f(variance);
  return sum;
}

}  // namespace

GaussianCurve::GaussianCurve(std::vector<Term> terms) : terms_(std::move(terms)) {
  for (const Term& term : terms_) widest_ = std::max(widest_, std::sqrt(term.variance));
}

std::vector<double> GaussianCurve::numbers() const {
  std::vector<double> all;
  for (const auto& [weight, variance] : terms_) all.insert(all.end(), {weight, variance});
  return all;
}

double GaussianCurve::radial(double r) const {
  return sum_over(terms_, [r](double v) { return std::exp(-r * r / (2 * v)) / (2 * pi * v); });
}

double GaussianCurve::disc(double r) const {
  return sum_over(terms_, [r](double v) { return -std::expm1(-r * r / (2 * v)); });
}

double GaussianCurve::disc_tail(double r) const {
  return sum_over(terms_, [r](double v) { return std::exp(-r * r / (2 * v)); });
}

double GaussianCurve::marginal(double x) const {
  return sum_over(terms_, [x](double v) { return std::exp(-x * x / (2 * v)) / std::sqrt(2 * pi * v); });
}

double GaussianCurve::edge_tail(double x) const {
  return sum_over(terms_, [x](double v) { return std::erfc(x / std::sqrt(2 * v)) / 2; });
}

double GaussianCurve::spectrum(double omega) const {
  return sum_over(terms_, [omega](double v) { return std::exp(-v * omega * omega / 2); });
}

double GaussianCurve::strip(double from, double to) const {
  return sum_over(terms_, [&](double v) { return normal_strip(from / std::sqrt(v), to / std::sqrt(v)); });
}

double GaussianCurve::rectangle(double x0, double x1, double y0, double y1) const {
  return sum_over(terms_, [&](double v) {
    const double deviation = std::sqrt(v);
    return normal_strip(x0 / deviation, x1 / deviation) * normal_strip(y0 / deviation, y1 / deviation);
  });
}

}  // namespace dermis
