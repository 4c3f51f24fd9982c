#include "taps/model/product_fit.hpp"

#include <unsupported/Eigen/NonLinearOptimization>

namespace dermis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Keeps coefficients of functions that are much alike from growing against each other.
constexpr double ridge = 1e-5;

/// The residuals and their derivatives, over the pairs i <= j.
struct Residuals {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming): the names that Eigen asks for
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const ProductFit& fit;
  int unknowns;

  int inputs() const { return unknowns; }
  int values() const { return static_cast<int>(pairs(fit.truth.rows()) + pairs(fit.floor.weight.rows())) + unknowns; }

  static Index pairs(Index n) { return n * (n + 1) / 2; }

  std::vector<VectorXd> functions(const VectorXd& c, bool at_floor) const {
    std::vector<VectorXd> result;
    const MatrixXd& basis = at_floor ? fit.floor.basis : fit.basis;
    Index first = 0;
    for (std::size_t p = 0; p < fit.products.size(); ++p) {
      const Index count = fit.products[p].coefficients.size();
      VectorXd f = at_floor ? fit.floor.starts[p] : fit.products[p].start;
      if (count > 0) f += basis * c.segment(first, count);
      first += count;
      result.push_back(std::move(f));
    }
    return result;
  }

  double sum_at(const std::vector<VectorXd>& f, Index i, Index j) const {
    double sum = 0;
    for (std::size_t p = 0; p < f.size(); ++p) sum += fit.products[p].sign * f[p][i] * f[p][j];
    return sum;
  }

  int operator()(const VectorXd& c, VectorXd& residuals) const {
    residuals.tail(unknowns) = ridge * c;
    Index row = 0;
    const auto f = functions(c, false);
    for (Index i = 0; i < fit.truth.rows(); ++i) {
      for (Index j = i; j < fit.truth.rows(); ++j) {
        residuals[row++] = fit.weight(i, j) * (sum_at(f, i, j) - fit.truth(i, j));
      }
    }
    if (fit.floor.weight.size() == 0) return 0;
    const auto g = functions(c, true);
    for (Index i = 0; i < fit.floor.weight.rows(); ++i) {
      for (Index j = i; j < fit.floor.weight.rows(); ++j) {
        residuals[row++] = fit.floor.weight(i, j) * std::min(0.0, sum_at(g, i, j));
      }
    }
    return 0;
  }

  void fill(const std::vector<VectorXd>& f, const MatrixXd& basis, double weight, Index i, Index j, Index row,
            MatrixXd& jacobian) const {
    Index first = 0;
    for (std::size_t p = 0; p < f.size(); ++p) {
      const Index count = fit.products[p].coefficients.size();
      if (count == 0) continue;
      jacobian.row(row).segment(first, count) =
          weight * fit.products[p].sign * (f[p][i] * basis.row(j) + f[p][j] * basis.row(i));
      first += count;
    }
  }

  int df(const VectorXd& c, MatrixXd& jacobian) const {
    jacobian.bottomRows(unknowns) = ridge * MatrixXd::Identity(unknowns, unknowns);
    Index row = 0;
    const auto f = functions(c, false);
    for (Index i = 0; i < fit.truth.rows(); ++i) {
      for (Index j = i; j < fit.truth.rows(); ++j) fill(f, fit.basis, fit.weight(i, j), i, j, row++, jacobian);
    }
    if (fit.floor.weight.size() == 0) return 0;
    const auto g = functions(c, true);
    for (Index i = 0; i < fit.floor.weight.rows(); ++i) {
      for (Index j = i; j < fit.floor.weight.rows(); ++j) {
        const double weight = sum_at(g, i, j) < 0 ? fit.floor.weight(i, j) : 0;
        fill(g, fit.floor.basis, weight, i, j, row++, jacobian);
      }
    }
    return 0;
  }
};

}  // namespace

void ProductFit::solve() {
  Index unknowns = 0;
  for (const Product& product : products) unknowns += product.coefficients.size();
  VectorXd c(unknowns);
  Index first = 0;
  for (const Product& product : products) {
    c.segment(first, product.coefficients.size()) = product.coefficients;
    first += product.coefficients.size();
  }
  Residuals residuals{*this, static_cast<int>(unknowns)};
  Eigen::LevenbergMarquardt<Residuals> solver(residuals);
  solver.parameters.ftol = 1e-5;
  solver.parameters.xtol = 1e-6;
  solver.parameters.maxfev = 60;
  solver.minimize(c);
  first = 0;
  for (Product& product : products) {
    product.coefficients = c.segment(first, product.coefficients.size());
    first += product.coefficients.size();
  }
}

VectorXd ProductFit::values(std::size_t product) const {
  const Product& p = products[product];
  return p.coefficients.size() > 0 ? VectorXd(p.start + basis * p.coefficients) : p.start;
}

}  // namespace dermis
