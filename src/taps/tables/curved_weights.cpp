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

/// What is tried as softening, as a multiple of x = 1: from least to most in steps of equal ratio of 1 + softening.
constexpr std::size_t softening_count = 14;

const std::array<double, softening_count>& softenings() {
  static const auto all = [] {
    constexpr double least = 0.05;
    constexpr double most = 15;
    std::array<double, softening_count> result;
    for (std::size_t i = 0; i < softening_count; ++i) {
      const double share = static_cast<double>(i) / (softening_count - 1);
      result[i] = (1 + least) * std::pow((1 + most) / (1 + least), share) - 1;
    }
    return result;
  }();
  return all;
}

struct Nodes {
  Values x;
  Values root;  ///< of x
  Values importance;
  std::array<Values, softening_count> nearness;  ///< 1 / (x + softening)
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
    nodes.root[i] = std::sqrt(nodes.x[i]);
    nodes.importance[i] = i < shorter.size() && !of_lengths ? 0 : std::pow(std::max(nodes.x[i], 1.0), -fading);
    for (std::size_t s = 0; s < softening_count; ++s) nodes.nearness[s][i] = 1 / (nodes.x[i] + softenings()[s]);
  }
  return nodes;
}

/// The functions that are fitted, each of one term and channel of a tap.
struct Functions {
  std::size_t count;
  std::vector<double> y;    ///< at the nodes, node by node
  std::vector<double> y_1;  ///< at x = 1
};

using Coefficients = std::array<double, 3>;

/// Fits t (A + t (B + t C)), exactly at x = 1, where t = max(scale / (x + softening) - end, 0) is 1 there and 0 from
/// x_end on.
class CubicFit {
 public:
  CubicFit(const Nodes& nodes, std::size_t number, double x_end)
      : importance_(nodes.importance), softening_(softenings()[number]) {
    const double at_end = 1 / (x_end + softening_);
    scale_ = 1 / (1 / (1 + softening_) - at_end);
    end_ = at_end * scale_;
    for (std::size_t i = 0; i < node_count; ++i) {
      linear_[i] = std::max(scale_ * nodes.nearness[number][i] - end_, 0.0);
      // By A + B + C = y(1), what is left to fit are the multiples B and C of these.
      square_less_[i] = linear_[i] * linear_[i] - linear_[i];
      cube_less_[i] = linear_[i] * linear_[i] * linear_[i] - linear_[i];
    }
    // All sums in one loop, so that none waits for another.
    for (std::size_t i = 0; i < node_count; ++i) {
      const double steep = cube_less_[i] - square_less_[i];
      const double linear = importance_[i] * linear_[i];
      const double square_less = importance_[i] * square_less_[i];
      ll_ += linear * linear_[i];
      bl_ += linear * square_less_[i];
      cl_ += linear * cube_less_[i];
      bb_ += square_less * square_less_[i];
      bc_ += square_less * cube_less_[i];
      cc_ += importance_[i] * cube_less_[i] * cube_less_[i];
      ss_ += importance_[i] * steep * steep;
      sq_ += importance_[i] * steep * (linear_[i] * linear_[i]);
    }
  }

  /// For x in units of `unit`.
  Nearness nearness(double unit) const {
    return {static_cast<float>(scale_ * unit), static_cast<float>(softening_ * unit), static_cast<float>(end_)};
  }

  /// A function's values at the nodes times t, t^2 - t and t^3 - t, which is all that a fit needs of them.
  struct Moments {
    double y_1, linear, square_less, cube_less;
  };

  void append_moments(const Functions& functions, std::vector<Moments>& moments) const {
    const std::size_t first = moments.size();
    for (const double y_1 : functions.y_1) moments.push_back({y_1, 0, 0, 0});
    const double* y = functions.y.data();
    for (std::size_t i = 0; i < node_count; ++i) {
      const double linear = importance_[i] * linear_[i];
      const double square_less = importance_[i] * square_less_[i];
      const double cube_less = importance_[i] * cube_less_[i];
      for (std::size_t f = 0; f < functions.count; ++f, ++y) {
        moments[first + f].linear += linear * *y;
        moments[first + f].square_less += square_less * *y;
        moments[first + f].cube_less += cube_less * *y;
      }
    }
  }

  /// The best fit.
  Coefficients cubic(const Moments& y) const {
    const double b = y.square_less - y.y_1 * bl_;
    const double c = y.cube_less - y.y_1 * cl_;
    const double determinant = bb_ * cc_ - bc_ * bc_;
    const double b_best = (cc_ * b - bc_ * c) / determinant;
    const double c_best = (bb_ * c - bc_ * b) / determinant;
    return {y.y_1 - b_best - c_best, b_best, c_best};
  }

  /// The best fit without A, which falls faster far away.
  Coefficients steep(const Moments& y) const {
    const double c_best = (y.cube_less - y.square_less - y.y_1 * sq_) / ss_;
    return {0, y.y_1 - c_best, c_best};
  }

  /// The squared error of a fit that is exact at x = 1, less the square of the function, which no fit changes.
  double squared_error(const Moments& y, const Coefficients& its) const {
    const auto [a, b, c] = its;
    return y.y_1 * (y.y_1 * ll_ + 2 * (b * bl_ + c * cl_ - y.linear)) + b * (b * bb_ - 2 * y.square_less) +
           c * (c * cc_ + 2 * (b * bc_ - y.cube_less));
  }

  /// Whether A + t (B + t C) is nowhere negative, from far away to no distance at all.
  bool is_not_negative(const Coefficients& its) const {
    const double last = scale_ / softening_ - end_;
    const double vertex = its[2] > 0 ? std::clamp(-its[1] / (2 * its[2]), 0.0, last) : 0;
    const auto at = [&](double t) { return its[0] + t * (its[1] + t * its[2]); };
    return its[0] >= 0 && at(last) >= 0 && at(vertex) >= 0;
  }

 private:
  const Values& importance_;
  double softening_, scale_, end_;
  Values linear_, square_less_, cube_less_;
  /// Sums over the nodes of products of t (l), t^2 - t (b), t^3 - t (c), t^3 - t^2 (s) and t^2 (q).
  double ll_ = 0, bl_ = 0, cl_ = 0, bb_ = 0, bc_ = 0, cc_ = 0, ss_ = 0, sq_ = 0;
};

/// A weight of a mean, which is nowhere negative.
Coefficients fit_mean(const CubicFit& fit, const CubicFit::Moments& its) {
  if (const Coefficients cubic = fit.cubic(its); fit.is_not_negative(cubic)) return cubic;
  if (const Coefficients steep = fit.steep(its); fit.is_not_negative(steep)) return steep;
  return {0, 0, its.y_1};
}

/// A weight of a difference. The mean divides by the weights of the first term where there is much surface far away,
/// and the difference is to grow no more than these: it has at most so many times their weight at any distance.
Coefficients fit_difference(const CubicFit& fit, const CubicFit::Moments& its, const Coefficients& of_first,
                            double first_1) {
  constexpr double most = 16;
  const auto is_within = [&](const Coefficients& candidate) {
    Coefficients below;
    Coefficients above;
    for (std::size_t i = 0; i < 3; ++i) {
      below[i] = most * of_first[i] - candidate[i];
      above[i] = most * of_first[i] + candidate[i];
    }
    return fit.is_not_negative(below) && fit.is_not_negative(above);
  };
  if (const Coefficients cubic = fit.cubic(its); is_within(cubic)) return cubic;
  if (const Coefficients steep = fit.steep(its); is_within(steep)) return steep;
  Coefficients like_first{};
  if (first_1 > 0) {
    for (std::size_t i = 0; i < 3; ++i) like_first[i] = its.y_1 / first_1 * of_first[i];
  }
  return like_first;
}

/// Appends the fit with the best softening, which all functions share. `unit` is what x = 1 stands for, mm or mm^2.
void append_best(const Nodes& nodes, const Functions& functions, const std::vector<TermCurves>& terms, bool is_centre,
                 double x_end, double unit, double factor, CurvedWeights& result) {
  double least_error = std::numeric_limits<double>::infinity();
  std::vector<Coefficients> best;
  std::vector<Coefficients> coefficients(functions.count);
  std::vector<CubicFit::Moments> moments;
  for (std::size_t i = 0; i < softening_count; ++i) {
    const CubicFit fit(nodes, i, x_end);
    moments.clear();
    fit.append_moments(functions, moments);
    double error = 0;
    for (std::size_t f = 0; f < functions.count; ++f) {
      const CubicFit::Moments& its = moments[f];
      if (is_centre) {
        coefficients[f] = fit.cubic(its);
      } else if (terms[f / 3].normalised) {
        coefficients[f] = fit_mean(fit, its);
      } else {
        coefficients[f] = fit_difference(fit, its, coefficients[f % 3], functions.y_1[f % 3]);
      }
      error += fit.squared_error(its, coefficients[f]);
    }
    if (i > 0 && !(error < least_error)) continue;
    least_error = error;
    best = coefficients;
    if (i > 0) result.nearness.pop_back();
    result.nearness.push_back(fit.nearness(unit));
  }
  for (std::size_t first = 0; first < functions.count; first += 3) {
    CubicWeight weight;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t power = 0; power < 3; ++power) {
        weight[power][c] = static_cast<float>(factor * best[first + c][power]);
      }
    }
    result.weights.push_back(weight);
  }
}

/// The values of the centre of a mean are what the pairs have: 1 less its own. The centre of a difference has no
/// weight.
void take_from_sums(const std::vector<TermCurves>& terms, double* weights) {
  for (std::size_t f = 0; f < 3 * terms.size(); ++f) weights[f] = terms[f / 3].normalised ? 1 - weights[f] : 0;
}

}  // namespace

CurvedWeights fit_curved_weights(const SurfaceWeights& weights, double radius_mm) {
  constexpr double least_x_end = 2;
  static const Nodes lengths = make_nodes(true);
  static const Nodes distances = make_nodes(false);
  const double px_per_mm = weights.px_per_mm();
  const std::size_t count = weights.functions();
  CurvedWeights result;
  Functions functions{count, std::vector<double>(node_count * count), std::vector<double>(count)};
  for (std::size_t row = 0; row < weights.rows(); ++row) {
    const bool is_centre = row == 0;
    const Nodes& nodes = is_centre ? lengths : distances;
    std::copy_n(weights.on_plane(row), count, functions.y_1.begin());
    if (is_centre) take_from_sums(weights.terms(), functions.y_1.data());
    for (std::size_t i = 0; i < node_count; ++i) {
      double* y = &functions.y[i * count];
      if (is_centre) {
        weights.on_surface(row, nodes.x[i], 1, y);
        take_from_sums(weights.terms(), y);
      } else {
        weights.on_surface(row, 1, nodes.root[i], y);
      }
    }
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
