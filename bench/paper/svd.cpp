#include "paper/svd.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <numbers>

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
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(folded, Eigen::ComputeThinU | Eigen::ComputeThinV);
    result.values[c] = svd.singularValues();
    for (int t = 0; t < most_terms; ++t) {
      // The matrix is symmetric: left and right vectors are the same but for the sign of the eigenvalue.
      const Eigen::VectorXd v = svd.matrixV().col(t);
      const double sign = svd.matrixU().col(t).dot(v) < 0 ? -1 : 1;
      Product product{sign * svd.singularValues()[t], Eigen::VectorXd::Zero(half_px + 1)};
      product.f.head(half_px) = v.cwiseQuotient(fold);
      result.products[c].push_back(product);
    }
  }
  return result;
}

}  // namespace dermis::bench
