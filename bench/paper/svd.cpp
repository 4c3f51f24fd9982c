#include "paper/svd.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace dermis::bench {

Products Svd::truncated(int rank) const {
  Products result;
  for (int c = 0; c < 3; ++c) result[c].assign(products[c].begin(), products[c].begin() + rank);
  return result;
}

Products Svd::renormalised(int rank) const {
  Products result = truncated(rank);
  for (auto& channel : result) {
    const double light = sum_of(channel);
    for (Product& product : channel) product.scale /= light;
  }
  return result;
}

Svd svd_of(const Sample& sample) {
  constexpr int most_terms = 20;
  Svd result;
  for (int c = 0; c < 3; ++c) {
    // An even matrix has even singular vectors: pixels other than those of the middle row stand for two.
    Eigen::VectorXd fold = Eigen::VectorXd::Constant(half_px, std::numbers::sqrt2);
    fold[0] = 1;
    const Eigen::MatrixXd folded =
        fold.asDiagonal() * sample.exact[c].topLeftCorner(half_px, half_px) * fold.asDiagonal();
    // The matrix is symmetric: its singular values are the absolute eigenvalues.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(folded);
    std::vector<Eigen::Index> order(half_px);
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
      return std::abs(eigen.eigenvalues()[a]) > std::abs(eigen.eigenvalues()[b]);
    });
    result.values[c] = eigen.eigenvalues()(order).cwiseAbs();
    for (int t = 0; t < most_terms; ++t) {
      Product product{eigen.eigenvalues()[order[t]], Eigen::VectorXd::Zero(half_px + 1)};
      product.f.head(half_px) = eigen.eigenvectors().col(order[t]).cwiseQuotient(fold);
      result.products[c].push_back(product);
    }
  }
  return result;
}

}  // namespace dermis::bench
