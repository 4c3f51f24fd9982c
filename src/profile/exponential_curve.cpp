#include "profile/exponential_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "profile/smooth_curve.hpp"

namespace dermis {

namespace {

/// One exponential with d = 1.
class UnitExponential final : public SmoothCurve {
 public:
  double radial(double r) const override { return std::exp(-r) / (2 * std::numbers::pi * r); }
  double disc(double r) const override { return -std::expm1(-r); }
  double disc_tail(double r) const override { return std::exp(-r); }
  double spectrum(double omega) const override { return 1 / std::hypot(1, omega); }
  double scale() const override { return 1; }
  double reach() const override { return 740; }

 private:
  std::vector<double> numbers() const override { return {}; }
};

constinit const UnitExponential unit;

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

double ExponentialCurve::reach() const { return unit.reach() * widest_; }

double ExponentialCurve::radial(double r) const {
  return sum_over(terms_, [r](double d) { return unit.radial(r / d) / (d * d); });
}

double ExponentialCurve::disc(double r) const {
  return sum_over(terms_, [r](double d) { return unit.disc(r / d); });
}

double ExponentialCurve::disc_tail(double r) const {
  return sum_over(terms_, [r](double d) { return unit.disc_tail(r / d); });
}

double ExponentialCurve::marginal(double x) const {
  return sum_over(terms_, [x](double d) { return unit.marginal(x / d) / d; });
}

double ExponentialCurve::edge_tail(double x) const {
  return sum_over(terms_, [x](double d) { return unit.edge_tail(x / d); });
}

double ExponentialCurve::spectrum(double omega) const {
  return sum_over(terms_, [omega](double d) { return unit.spectrum(omega * d); });
}

}  // namespace dermis
