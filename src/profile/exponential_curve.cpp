#include "profile/exponential_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace dermis {

namespace {

template <class Function>
double sum_over(const std::vector<ExponentialCurve::Term>& terms, const Function& f) {
  double sum = 0;
  for (const auto& [weight, d] : terms) sum += weight * f(d);
  return sum;
}

}  // namespace

ExponentialCurve::ExponentialCurve(std::vector<Term> terms) : terms_(std::move(terms)) {
  // The tail falls fastest at r = 0.
  scale_ = 1 / sum_over(terms_, [](double d) { return 1 / d; });
  for (const Term& term : terms_) widest_ = std::max(widest_, term.d);
}

std::vector<double> ExponentialCurve::numbers() const {
  std::vector<double> all;
  for (const auto& [weight, d] : terms_) all.insert(all.end(), {weight, d});
  return all;
}

double ExponentialCurve::radial(double r) const {
  return sum_over(terms_, [r](double d) { return std::exp(-r / d) / d; }) / (2 * std::numbers::pi * r);
}

double ExponentialCurve::disc(double r) const {
  return sum_over(terms_, [r](double d) { return -std::expm1(-r / d); });
}

double ExponentialCurve::disc_tail(double r) const {
  return sum_over(terms_, [r](double d) { return std::exp(-r / d); });
}

double ExponentialCurve::spectrum(double omega) const {
  return sum_over(terms_, [omega](double d) { return 1 / std::hypot(1, omega * d); });
}

}  // namespace dermis
