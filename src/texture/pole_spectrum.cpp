#include "texture/pole_spectrum.hpp"

#include <cmath>
#include <complex>

#include "taps/model/least_squares.hpp"

namespace dermis {

using Eigen::VectorXd;

namespace {

constexpr double least_balance = -0.7;  // poles that turn faster ring

/// Two poles that nearly meet have shares of opposite signs without bound, which float32 would pay for.
double apart(double balance) {
  constexpr double closest = 0.01;
  if (std::abs(balance - 1) >= closest) return balance;
  return balance < 1 ? 1 - closest : 1 + closest;
}

}  // namespace

PoleSpectrum::Pair PoleSpectrum::pair(const VectorXd& parameters, int number) const {
  const auto at = parameters.segment(Eigen::Index{4} * number, number + 1 < Recursion::pairs ? 4 : 3);
  double share = integral_;
  if (number + 1 < Recursion::pairs) {
    share = at[3];
  } else {
    for (int other = 0; other < number; ++other) share -= parameters[4 * other + 3];
  }
  return {std::exp(at[0]), apart(least_balance + std::exp(at[1])), at[2], share};
}

VectorXd PoleSpectrum::values(const VectorXd& parameters, const VectorXd& squared_omega) const {
  VectorXd sum = VectorXd::Zero(squared_omega.size());
  for (int k = 0; k < Recursion::pairs; ++k) {
    const Pair its = pair(parameters, k);
    const auto w = squared_omega.array() / its.squared_rate;
    sum.array() += (its.share + its.slope * w) / (w.square() + 2 * its.balance * w + 1);
  }
  return sum;
}

Recursion::Function PoleSpectrum::function(const VectorXd& parameters) const {
  Recursion::Function function;
  for (int k = 0; k < Recursion::pairs; ++k) {
    const auto [squared_rate, balance, slope, share] = pair(parameters, k);
    // The poles are at w = -p with p + p' = 2 balance and p p' = 1; a share is what is left of the pair there.
    PolePair& its = function[k];
    const double scale = std::sqrt(squared_rate);
    if (balance > 1) {
      const double p = balance + std::sqrt(balance * balance - 1);
      const double other = 1 / p;
      its.rate_per_mm = {scale * std::sqrt(p), scale * std::sqrt(other)};
      its.share = {(share - slope * p) / (other - p) / p, (share - slope * other) / (p - other) / other};
    } else {
      const std::complex<double> p(balance, std::sqrt(1 - balance * balance));
      const std::complex<double> rate = scale * std::sqrt(p);
      const std::complex<double> both = 2.0 * (share - slope * p) / (std::conj(p) - p) / p;
      its.rate_per_mm = {rate.real(), rate.real()};
      its.turn_per_mm = rate.imag();
      its.share = {both.real(), both.imag()};
    }
  }
  return function;
}

VectorXd PoleSpectrum::fit(const VectorXd& squared_omega, const VectorXd& truth, const VectorXd& weight,
                           double scale) const {
  VectorXd best;
  double least = HUGE_VAL;
  const auto residuals = [&](const VectorXd& x) -> VectorXd {
    return weight.cwiseProduct(values(x, squared_omega) - truth);
  };
  for (const double near : {1.0, 0.5}) {
    for (const double ratio : {4.0, 30.0, 300.0}) {
      for (const double balance : {0.5, 1.5}) {
        VectorXd x(unknowns);
        x << 2 * std::log(near * scale), std::log(balance - least_balance), 0.5, integral_ / 2,
            2 * std::log(near * scale) + std::log(ratio), std::log(balance - least_balance), 0.5;
        const double norm = least_squares(x, residuals, 600);
        if (x.allFinite() && norm < least) {
          least = norm;
          best = x;
        }
      }
    }
  }
  return best;
}

}  // namespace dermis
