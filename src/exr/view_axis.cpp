#include "exr/view_axis.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "exr/outliers.hpp"

namespace dermis::exr {
namespace {

using Projection = Camera::Projection;
using Matrix34 = Eigen::Matrix<double, 3, 4>;
using Rows = std::vector<Eigen::Index>;

constexpr Eigen::Index points_of_start = 8;  // six determine a camera
constexpr std::size_t most_fitted = 20000;
constexpr double relief_over_noise = 30;

/// Points (X, 1) about their middle and pixels, both with a spread of about 1: what makes the fit well conditioned
/// (Hartley 1997).
struct Normalised {
  Eigen::Matrix<double, Eigen::Dynamic, 4> point;
  Eigen::Matrix<double, Eigen::Dynamic, 2> pixel;
  Eigen::RowVector3d middle;
  double unit = 1;      ///< scene units
  double pixel_px = 1;  ///< px
  double largest = 0;   ///< |P|, scene units
};

Normalised normalised(std::span<const SeenPoint> points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd position(n, 3);
  Normalised out;
  out.point.resize(n, 4);
  out.pixel.resize(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const SeenPoint& point = points[static_cast<std::size_t>(i)];
    position.row(i) << point.position[0], point.position[1], point.position[2];
    out.pixel.row(i) << point.x_px, point.y_px;
  }
  std::vector<double> distances;
  for (int k = 0; k < 3; ++k) out.middle(k) = median({position.col(k).begin(), position.col(k).end()});
  position.rowwise() -= out.middle;
  for (Eigen::Index i = 0; i < n; ++i) distances.push_back(position.row(i).norm());
  const double typical = median(distances);
  out.unit = typical > 0 ? typical : 1;
  out.largest = out.middle.norm() + out.unit;
  out.point << position / out.unit, Eigen::VectorXd::Ones(n);
  const Eigen::RowVector2d center = out.pixel.colwise().mean();
  out.pixel.rowwise() -= center;
  out.pixel_px = std::max(out.pixel.cwiseAbs().maxCoeff(), 0.5);
  out.pixel /= out.pixel_px;
  return out;
}

/// A camera matrix, pixel ~ M (X, 1), and how well the points determine it.
struct Solution {
  Matrix34 matrix = Matrix34::Zero();
  double relief = 0;  ///< 0 if another matrix would do as well
  Rows kept = {};     ///< the points that it was fitted to, in the end
};

/// The direct linear transform: the matrix that makes m1 X - x m3 X and m2 X - y m3 X least, each point divided by its
/// depth in the solution before, so that errors are those on the picture.
Solution perspective(const Normalised& all, const Rows& rows, const Matrix34& before) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(2 * n, 12);
  const double depth_of_middle = std::abs(before(2, 3));
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::RowVector4d point = all.point.row(rows[static_cast<std::size_t>(k)]);
    const Eigen::RowVector2d pixel = all.pixel.row(rows[static_cast<std::size_t>(k)]);
    const double depth = std::abs(before.row(2).dot(point));
    const double weight = depth_of_middle > 0 ? 1 / std::max(depth / depth_of_middle, 0.1) : 1;
    system.block<1, 4>(2 * k, 0) = weight * point;
    system.block<1, 4>(2 * k, 8) = -weight * pixel(0) * point;
    system.block<1, 4>(2 * k + 1, 4) = weight * point;
    system.block<1, 4>(2 * k + 1, 8) = -weight * pixel(1) * point;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(12).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeFullV);
  const Eigen::VectorXd m = svd.matrixV().col(11);
  Solution solution;
  solution.matrix << m.segment<4>(0).transpose(), m.segment<4>(4).transpose(), m.segment<4>(8).transpose();
  solution.relief = svd.singularValues()(10) / std::sqrt(static_cast<double>(n));
  return solution;
}

Solution orthographic(const Normalised& all, const Rows& rows) {
  const Eigen::MatrixXd system = all.point(rows, Eigen::all);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(4).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd m = qr.solve(Eigen::MatrixXd(all.pixel(rows, Eigen::all)));
  Solution solution;
  solution.matrix << m.col(0).transpose(), m.col(1).transpose(), 0, 0, 0, 1;
  solution.relief =
      Eigen::JacobiSVD<Eigen::MatrixXd>(r).singularValues()(3) / std::sqrt(static_cast<double>(system.rows()));
  return solution;
}

Solution solve(Projection projection, const Normalised& all, const Rows& rows, const Matrix34& before) {
  return projection == Projection::perspective ? perspective(all, rows, before) : orthographic(all, rows);
}

std::vector<double> errors_px(const Normalised& all, const Rows& rows, const Matrix34& matrix) {
  std::vector<double> errors;
  for (const Eigen::Index i : rows) {
    const Eigen::Vector3d seen = matrix * all.point.row(i).transpose();
    const double error = (seen.head<2>() / seen(2) - all.pixel.row(i).transpose()).norm() * all.pixel_px;
    errors.push_back(error_or_huge(error));
  }
  return errors;
}

/// The fit to few points, or to all, with the least median error: false points would bend a fit to all.
Solution best_start(Projection projection, const Normalised& all) {
  const auto n = static_cast<std::size_t>(all.point.rows());
  const Rows judges = spread(n, points_to_judge_start);
  Solution best = solve(projection, all, spread(n, most_fitted), Matrix34::Zero());
  double least = median(errors_px(all, judges, best.matrix));
  std::minstd_rand random;  // the same numbers in every run
  for (int i = 0; i < starts; ++i) {
    Rows few;
    for (Eigen::Index k = 0; k < points_of_start; ++k) few.push_back(static_cast<Eigen::Index>(random() % n));
    const Solution solution = solve(projection, all, few, Matrix34::Zero());
    const double error = median(errors_px(all, judges, solution.matrix));
    if (error < least) {
      least = error;
      best = solution;
    }
  }
  return best;
}

Solution without_false_points(Projection projection, const Normalised& all) {
  const Rows every = spread(static_cast<std::size_t>(all.point.rows()), most_fitted);
  Solution solution = best_start(projection, all);
  for (int i = 0; i < most_refits; ++i) {
    const std::vector<double> errors = errors_px(all, every, solution.matrix);
    const double limit = limit_px(errors);
    Rows within;
    for (std::size_t k = 0; k < every.size(); ++k)
      if (errors[k] <= limit) within.push_back(every[k]);
    if (static_cast<Eigen::Index>(within.size()) < points_of_start) break;
    const bool is_last = within == solution.kept;
    solution = solve(projection, all, within, solution.matrix);
    solution.kept = std::move(within);
    if (is_last) break;
  }
  return solution;
}

/// Depth along a direction in normalised space, as that of positions.
ViewAxis axis_along(const Normalised& all, const Eigen::RowVector3d& direction, double depth_of_middle) {
  return {{direction(0), direction(1), direction(2)}, depth_of_middle - direction.dot(all.middle)};
}

ViewAxis perspective_axis(const Normalised& all, const Matrix34& matrix) {
  Eigen::RowVector4d depth = matrix.row(2) / matrix.row(2).head<3>().norm();
  std::vector<double> depths;
  for (Eigen::Index i = 0; i < all.point.rows(); ++i) depths.push_back(depth.dot(all.point.row(i)));
  if (median(depths) < 0) depth = -depth;
  return axis_along(all, depth.head<3>(), depth(3) * all.unit);
}

ViewAxis orthographic_axis(const Normalised& all, const Solution& solution) {
  const Eigen::Vector3d right = solution.matrix.row(0).head<3>();
  const Eigen::Vector3d down = solution.matrix.row(1).head<3>();
  const Eigen::RowVector3d forward = right.cross(down).normalized().transpose();
  const Eigen::VectorXd depths = all.point(solution.kept, Eigen::seqN(0, 3)) * forward.transpose();
  const double extent = depths.maxCoeff() - depths.minCoeff();
  return axis_along(all, forward, (extent - depths.minCoeff() + 1) * all.unit);
}

}  // namespace

std::optional<ViewAxis> find_view_axis(Projection projection, std::span<const SeenPoint> points, double rounding) {
  if (static_cast<Eigen::Index>(points.size()) < points_of_start) return std::nullopt;
  const Normalised all = normalised(points);
  const Solution solution = without_false_points(projection, all);
  const double noise = rounding * all.largest / all.unit;
  if (!(solution.relief >= relief_over_noise * noise) || solution.kept.empty()) return std::nullopt;
  return projection == Projection::perspective ? perspective_axis(all, solution.matrix)
                                               : orthographic_axis(all, solution);
}

}  // namespace dermis::exr
