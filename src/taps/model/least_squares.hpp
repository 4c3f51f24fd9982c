// Levenberg and Marquardt's method with differences in place of derivatives.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <utility>

namespace dermis {

/// A function from parameters to residuals, as Eigen's solver takes it.
template <class Residuals>
struct LeastSquaresProblem {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Residuals residuals;
  int input_count, value_count;

  int inputs() const { return input_count; }
  int values() const { return value_count; }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& result) const {
    result = residuals(x);
    return 0;
  }
};

/// Takes x to where the residuals are least, near where it starts; returns their norm.
template <class Residuals>
double least_squares(Eigen::VectorXd& x, const Residuals& residuals, int most_evaluations) {
  LeastSquaresProblem<Residuals> problem{residuals, static_cast<int>(x.size()), static_cast<int>(residuals(x).size())};
  Eigen::NumericalDiff<LeastSquaresProblem<Residuals>> functor(problem);
  Eigen::LevenbergMarquardt<decltype(functor)> solver(functor);
  solver.parameters.maxfev = most_evaluations;
  solver.minimize(x);
  return residuals(x).norm();
}

}  // namespace dermis
