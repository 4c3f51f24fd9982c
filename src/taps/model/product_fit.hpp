// Least squares: a symmetric function of two variables as a sum of products of functions of one.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dermis {

/// truth(i, j) ~ sum over terms of sign f(i) f(j), with f = start + basis c. Samples are those of x (or frequency) i
/// and y j; weight(i, j) multiplies the difference.
struct ProductFit {
  Eigen::MatrixXd truth;
  Eigen::MatrixXd weight;
  Eigen::MatrixXd basis;  ///< a function per column

  struct Product {
    double sign = 1;
    Eigen::VectorXd start;         ///< f at c = 0
    Eigen::VectorXd coefficients;  ///< c, in and out; empty if f is fixed
  };
  std::vector<Product> products;

  /// Another grid, on which the sum of products must not be negative: its negative part times `weight` counts as an
  /// error too. Empty if it may be negative everywhere.
  struct Floor {
    Eigen::MatrixXd weight;
    Eigen::MatrixXd basis;
    std::vector<Eigen::VectorXd> starts;  ///< of each product
  };
  Floor floor;

  /// Makes the sum of squares least over all c, by Levenberg and Marquardt's method.
  void solve();

  Eigen::VectorXd values(std::size_t product) const;
};

}  // namespace dermis
