#include "taps/tables/curved_weights.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace dermis {

namespace {

/// Where weights are fitted: at squared distances, or lengths, of so many times those on the plane.
struct Nodes {
  std::vector<double> x;
  Eigen::ArrayXd importance;

  /// Weights matter most near the plane, as surfaces are seldom steep.
  explicit Nodes(std::span<const double> more = {}) : x(more.begin(), more.end()) {
    constexpr int count = 20;
    constexpr double first = 0.8;
    constexpr double last = 50;
    constexpr double fading = 0.6;
    for (int i = 0; i < count; ++i) x.push_back(first * std::pow(last / first, i / (count - 1.0)));
    importance.resize(static_cast<Eigen::Index>(x.size()));
    for (std::size_t i = 0; i < x.size(); ++i) {
      importance[static_cast<Eigen::Index>(i)] = std::pow(std::max(x[i], 1.0), -fading);
    }
  }
};

using Coefficients = std::array<double, 3>;

/// Fits t (A + t (B + t C)) with t = (1 + softening) / (x + softening), exactly at x = 1.
class CubicFit {
 public:
  CubicFit(const Nodes& nodes, double softening) : softening_(softening), importance_(nodes.importance) {
    const auto count = static_cast<Eigen::Index>(nodes.x.size());
    t_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) t_[i] = (1 + softening) / (nodes.x[i] + softening);
    // By A + B + C = y(1), what is left to fit are the multiples B and C of these.
    Eigen::MatrixXd basis(count, 2);
    basis << t_ * t_ - t_, t_ * t_ * t_ - t_;
    cubic_ = solver(basis);
    steep_ = solver((t_ * t_ * t_ - t_ * t_).matrix());
  }

  double softening() const { return softening_; }

  /// `y` has the values at the nodes, y_1 the one at x = 1.
  Coefficients fit(const Eigen::ArrayXd& y, double y_1, bool not_negative) const {
    const Eigen::Vector2d rest = cubic_ * (y - y_1 * t_).matrix();
    const Coefficients cubic{y_1 - rest[0] - rest[1], rest[0], rest[1]};
    if (!not_negative || is_not_negative(cubic)) return cubic;
    // Without A it falls faster with distance than the surface grows.
    const double c = (steep_ * (y - y_1 * t_ * t_).matrix()).value();
    const Coefficients steep{0, y_1 - c, c};
    return is_not_negative(steep) ? steep : Coefficients{0, 0, y_1};
  }

  double squared_error(const Eigen::ArrayXd& y, const Coefficients& its) const {
    return (importance_ * (t_ * (its[0] + t_ * (its[1] + t_ * its[2])) - y).square()).sum();
  }

 private:
  Eigen::MatrixXd solver(const Eigen::MatrixXd& basis) const {
    const Eigen::MatrixXd weighted = importance_.matrix().asDiagonal() * basis;
    return (basis.transpose() * weighted).ldlt().solve(weighted.transpose());
  }

  /// From far away to no distance at all.
  bool is_not_negative(const Coefficients& its) const {
    const auto [a, b, c] = its;
    const double last = (1 + softening_) / softening_;
    const double vertex = c > 0 ? std::clamp(-b / (2 * c), 0.0, last) : 0;
    const auto at = [&](double t) { return a + t * (b + t * c); };
    return a >= 0 && at(last) >= 0 && at(vertex) >= 0;
  }

  double softening_;
  Eigen::ArrayXd importance_;
  Eigen::ArrayXd t_;
  Eigen::MatrixXd cubic_;
  Eigen::MatrixXd steep_;
};

std::vector<CubicFit> make_fits(const Nodes& nodes) {
  constexpr int count = 14;
  constexpr double least = 0.05;
  constexpr double most = 15;
  std::vector<CubicFit> fits;
  for (int i = 0; i < count; ++i) {
    fits.emplace_back(nodes, (1 + least) * std::pow((1 + most) / (1 + least), i / (count - 1.0)) - 1);
  }
  return fits;
}

/// A function that is fitted: of one term and channel of a tap.
struct Function {
  Eigen::ArrayXd y;
  double y_1;
  bool not_negative;
};

/// Appends the fit with the best softening, which all functions share. `unit` is what x = 1 stands for, mm or mm^2.
void append_best(const std::vector<CubicFit>& fits, const std::vector<Function>& functions, double unit, double factor,
                 CurvedWeights& result) {
  double least_error = INFINITY;
  const CubicFit* best = nullptr;
  std::vector<Coefficients> best_coefficients;
  std::vector<Coefficients> coefficients(functions.size());
  for (const CubicFit& fit : fits) {
    double error = 0;
    for (std::size_t i = 0; i < functions.size(); ++i) {
      const Function& its = functions[i];
      coefficients[i] = fit.fit(its.y, its.y_1, its.not_negative);
      error += fit.squared_error(its.y, coefficients[i]);
    }
    if (best != nullptr && !(error < least_error)) continue;
    least_error = error;
    best = &fit;
    best_coefficients = coefficients;
  }
  result.nearness.push_back(
      {static_cast<float>((1 + best->softening()) * unit), static_cast<float>(best->softening() * unit)});
  for (std::size_t first = 0; first < functions.size(); first += 3) {
    CubicWeight weight;
    for (std::size_t c = 0; c < 3; ++c) {
      for (int power = 0; power < 3; ++power) {
        weight[power][c] = static_cast<float>(factor * best_coefficients[first + c][power]);
      }
    }
    result.weights.push_back(weight);
  }
}

}  // namespace

CurvedWeights fit_curved_weights(const SurfaceWeights& weights) {
  // A pixel that its material covers in part counts as less surface.
  static constexpr std::array shorter = {0.0, 0.1, 0.25, 0.5};
  static const Nodes lengths(shorter);
  static const Nodes distances;
  static const std::vector<CubicFit> centre_fits = make_fits(lengths);
  static const std::vector<CubicFit> pair_fits = make_fits(distances);
  CurvedWeights result;
  std::vector<Function> functions(3 * weights.terms().size());
  for (std::size_t row = 0; row < weights.rows(); ++row) {
    const bool is_centre = row == 0;
    const Nodes& nodes = is_centre ? lengths : distances;
    for (std::size_t t = 0; t < weights.terms().size(); ++t) {
      const bool normalised = weights.terms()[t].normalised;
      for (int c = 0; c < 3; ++c) {
        const auto value = [&](double x) {
          if (!is_centre) return weights.on_surface(row, t, c, 1, std::sqrt(x));
          return normalised ? 1 - weights.on_surface(0, t, c, x, 1) : 0;
        };
        Function& its = functions[3 * t + static_cast<std::size_t>(c)];
        its.not_negative = normalised && !is_centre;
        its.y_1 = value(1);
        its.y.resize(static_cast<Eigen::Index>(nodes.x.size()));
        for (std::size_t i = 0; i < nodes.x.size(); ++i) its.y[static_cast<Eigen::Index>(i)] = value(nodes.x[i]);
      }
    }
    const double px_per_mm = weights.px_per_mm();
    if (is_centre) {
      append_best(centre_fits, functions, 1 / px_per_mm, 1, result);
    } else {
      const double distance_mm = weights.offsets_px()[row - 1] / px_per_mm;
      // A pixel of the level spans 1 / px_per_mm of surface.
      append_best(pair_fits, functions, distance_mm * distance_mm, px_per_mm, result);
    }
  }
  return result;
}

}  // namespace dermis
