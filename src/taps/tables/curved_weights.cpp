#include "taps/tables/curved_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dermis {

namespace {

/// Where weights are fitted: at squared distances, or lengths, of x times those on the plane.
constexpr std::size_t node_count = 24;
using Values = std::array<double, node_count>;

struct Nodes {
  Values x;
  Values importance;
};

/// No distance is much shorter than on the plane, but the length of a pixel that its material covers in part is.
Nodes make_nodes(bool of_lengths) {
  constexpr std::array shorter = {0.0, 0.1, 0.25, 0.5};
  constexpr double first = 0.8;
  constexpr double last = 50;
  constexpr double fading = 0.75;  // surfaces are seldom steep
  Nodes nodes;
  for (std::size_t i = 0; i < node_count; ++i) {
    const double step = static_cast<double>(i - shorter.size()) / (node_count - shorter.size() - 1);
    nodes.x[i] = i < shorter.size() ? shorter[i] : first * std::pow(last / first, step);
    nodes.importance[i] = i < shorter.size() && !of_lengths ? 0 : std::pow(std::max(nodes.x[i], 1.0), -fading);
  }
  return nodes;
}

double product(const Values& a, const Values& b, const Values& importance) {
  double sum = 0;
  for (std::size_t i = 0; i < node_count; ++i) sum += importance[i] * a[i] * b[i];
  return sum;
}

using Coefficients = std::array<double, 3>;

/// Fits t (A + t (B + t C)), exactly at x = 1, where t = max(scale / (x + softening) - end, 0) is 1 there and 0 from
/// x_end on.
class CubicFit {
 public:
  CubicFit(const Nodes& nodes, double softening, double x_end) : importance_(nodes.importance), softening_(softening) {
    const double at_end = 1 / (x_end + softening);
    scale_ = 1 / (1 / (1 + softening) - at_end);
    end_ = at_end * scale_;
    for (std::size_t i = 0; i < node_count; ++i) {
      const double t = std::max(scale_ / (nodes.x[i] + softening) - end_, 0.0);
      linear_[i] = t;
      square_[i] = t * t;
      // By A + B + C = y(1), what is left to fit are the multiples B and C of these.
      square_less_[i] = t * t - t;
      cube_less_[i] = t * t * t - t;
      steep_[i] = t * t * t - t * t;
    }
    bb_ = product(square_less_, square_less_, importance_);
    bc_ = product(square_less_, cube_less_, importance_);
    cc_ = product(cube_less_, cube_less_, importance_);
    ss_ = product(steep_, steep_, importance_);
  }

  /// For x in units of `unit`.
  Nearness nearness(double unit) const {
    return {static_cast<float>(scale_ * unit), static_cast<float>(softening_ * unit), static_cast<float>(end_)};
  }

  /// The best fit to the values y at the nodes; y_1 is the one at x = 1.
  Coefficients cubic(const Values& y, double y_1) const {
    Values rest;
    for (std::size_t i = 0; i < node_count; ++i) rest[i] = y[i] - y_1 * linear_[i];
    const double b = product(square_less_, rest, importance_);
    const double c = product(cube_less_, rest, importance_);
    const double determinant = bb_ * cc_ - bc_ * bc_;
    const double b_best = (cc_ * b - bc_ * c) / determinant;
    const double c_best = (bb_ * c - bc_ * b) / determinant;
    return {y_1 - b_best - c_best, b_best, c_best};
  }

  /// The best fit without A, which falls faster far away.
  Coefficients steep(const Values& y, double y_1) const {
    Values rest;
    for (std::size_t i = 0; i < node_count; ++i) rest[i] = y[i] - y_1 * square_[i];
    const double c_best = product(steep_, rest, importance_) / ss_;
    return {0, y_1 - c_best, c_best};
  }

  double squared_error(const Values& y, const Coefficients& its) const {
    Values off;
    for (std::size_t i = 0; i < node_count; ++i) {
      off[i] = linear_[i] * (its[0] + linear_[i] * (its[1] + linear_[i] * its[2])) - y[i];
    }
    return product(off, off, importance_);
  }

  /// Whether A + t (B + t C) is nowhere negative, from far away to no distance at all.
  bool is_not_negative(const Coefficients& its) const {
    const auto [a, b, c] = its;
    const double last = scale_ / softening_ - end_;
    const double vertex = c > 0 ? std::clamp(-b / (2 * c), 0.0, last) : 0;
    const auto at = [&](double t) { return a + t * (b + t * c); };
    return a >= 0 && at(last) >= 0 && at(vertex) >= 0;
  }

 private:
  const Values& importance_;
  double softening_, scale_, end_;
  Values linear_, square_, square_less_, cube_less_, steep_;
  double bb_, bc_, cc_, ss_;
};

/// A function that is fitted: of one term and channel of a tap.
struct Function {
  Values y;
  double y_1;
};

/// A weight of a mean, which is nowhere negative.
Coefficients fit_mean(const CubicFit& fit, const Function& its) {
  for (const Coefficients& candidate : {fit.cubic(its.y, its.y_1), fit.steep(its.y, its.y_1)}) {
    if (fit.is_not_negative(candidate)) return candidate;
  }
  return {0, 0, its.y_1};
}

/// A weight of a difference. The mean divides by the weights of the first term where there is much surface far away,
/// and the difference is to grow no more than these: it has at most so many times their weight at any distance.
Coefficients fit_difference(const CubicFit& fit, const Function& its, const Coefficients& of_first, double first_1) {
  constexpr double most = 16;
  for (const Coefficients& candidate : {fit.cubic(its.y, its.y_1), fit.steep(its.y, its.y_1)}) {
    Coefficients below, above;
    for (std::size_t i = 0; i < 3; ++i) {
      below[i] = most * of_first[i] - candidate[i];
      above[i] = most * of_first[i] + candidate[i];
    }
    if (fit.is_not_negative(below) && fit.is_not_negative(above)) return candidate;
  }
  Coefficients like_first{};
  if (first_1 > 0) {
    for (std::size_t i = 0; i < 3; ++i) like_first[i] = its.y_1 / first_1 * of_first[i];
  }
  return like_first;
}

/// Appends the fit with the best softening, which all functions share. `unit` is what x = 1 stands for, mm or mm^2.
void append_best(const Nodes& nodes, const std::vector<Function>& functions, const std::vector<TermCurves>& terms,
                 bool is_centre, double x_end, double unit, double factor, CurvedWeights& result) {
  constexpr int count = 14;
  constexpr double least = 0.05;
  constexpr double most = 15;
  double least_error = std::numeric_limits<double>::infinity();
  std::vector<Coefficients> best;
  std::vector<Coefficients> coefficients(functions.size());
  for (int i = 0; i < count; ++i) {
    const double softening = (1 + least) * std::pow((1 + most) / (1 + least), i / (count - 1.0)) - 1;
    const CubicFit fit(nodes, softening, x_end);
    double error = 0;
    for (std::size_t f = 0; f < functions.size(); ++f) {
      const Function& its = functions[f];
      if (is_centre) {
        coefficients[f] = fit.cubic(its.y, its.y_1);
      } else if (terms[f / 3].normalised) {
        coefficients[f] = fit_mean(fit, its);
      } else {
        coefficients[f] = fit_difference(fit, its, coefficients[f % 3], functions[f % 3].y_1);
      }
      error += fit.squared_error(its.y, coefficients[f]);
    }
    if (i > 0 && !(error < least_error)) continue;
    least_error = error;
    best = coefficients;
    if (i > 0) result.nearness.pop_back();
    result.nearness.push_back(fit.nearness(unit));
  }
  for (std::size_t first = 0; first < functions.size(); first += 3) {
    CubicWeight weight;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t power = 0; power < 3; ++power) {
        weight[power][c] = static_cast<float>(factor * best[first + c][power]);
      }
    }
    result.weights.push_back(weight);
  }
}

}  // namespace

CurvedWeights fit_curved_weights(const SurfaceWeights& weights, double radius_mm) {
  constexpr double least_x_end = 2;
  static const Nodes lengths = make_nodes(true);
  static const Nodes distances = make_nodes(false);
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
        its.y_1 = value(1);
        std::transform(nodes.x.begin(), nodes.x.end(), its.y.begin(), value);
      }
    }
    const double px_per_mm = weights.px_per_mm();
    if (is_centre) {
      append_best(nodes, functions, weights.terms(), true, std::numeric_limits<double>::infinity(), 1 / px_per_mm, 1,
                  result);
    } else {
      const double distance_mm = weights.offsets_px()[row - 1] / px_per_mm;
      const double end = 2 * radius_mm / distance_mm;
      // A pixel of the level spans 1 / px_per_mm of surface.
      append_best(nodes, functions, weights.terms(), false, std::max(end * end, least_x_end), distance_mm * distance_mm,
                  px_per_mm, result);
    }
  }
  return result;
}

}  // namespace dermis
