#include "exr/projection_start.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "exr/median.hpp"

namespace dermis::exr {
namespace {

// Of samples of 7 points, 30 % of all points false, 8 % are without one. That all of 400 have one, or all but such as
// lie nearly on one plane (two in three where a floor takes 71 % of the points), happens once in 10^5 pictures.
constexpr int samples = 400;
constexpr std::size_t judges = 500;
constexpr double least_closeness = 0.02;  // per unit; below it a search from parallel rays finds the lens
constexpr double least_relief = 1e-9;     // of the second smallest eigenvalue; below it two solutions are as good

/// Axes from rows that should be to the right and down, and one that is forward, made perpendicular.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& right, const Eigen::Vector3d& down, const Eigen::Vector3d& forward) {
  Eigen::Matrix3d axes;
  axes.row(0) = right.normalized();
  axes.row(1) = down.normalized();
  axes.row(2) = forward.normalized();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

std::optional<Projection> checked(const Projection& projection) {
  const bool is_finite = projection.axes.allFinite() && projection.middle_px.allFinite() &&
                         projection.slant.allFinite() && projection.scale.allFinite() &&
                         projection.scale.minCoeff() > 0 && std::isfinite(projection.closeness);
  return is_finite ? std::optional(projection) : std::nullopt;
}

/// The projection of pixel = (m + A P) / (1 + g P).
std::optional<Projection> projection_of(const Eigen::Vector2d& middle_px, const Eigen::Matrix<double, 2, 3>& a,
                                        const Eigen::Vector3d& g) {
  Projection out;
  out.middle_px = middle_px;
  const Eigen::Matrix<double, 2, 3> across = a - middle_px * g.transpose();
  // The direction of a small g is that of its errors.
  const bool is_lens = g.norm() > least_closeness;
  Eigen::Vector3d forward = is_lens ? g : Eigen::Vector3d(across.row(0).cross(across.row(1)).transpose());
  forward = (forward.dot(g) < 0 ? -1 : 1) * forward.normalized();
  out.closeness = forward.dot(g);
  out.slant = across * forward;
  const Eigen::Vector3d right = across.row(0).transpose() - out.slant.x() * forward;
  const Eigen::Vector3d down = across.row(1).transpose() - out.slant.y() * forward;
  out.scale = {right.norm(), down.norm()};
  out.axes = axes_of(right, down, forward);
  return checked(out);
}

}  // namespace

Projection as_parallel(const Projection& projection) {
  const Eigen::Matrix<double, 2, 3> across =
      projection.scale.asDiagonal() * projection.axes.topRows<2>() + projection.slant * projection.axes.row(2);
  return projection_of(projection.middle_px, across, Eigen::Vector3d::Zero()).value_or(projection);
}

std::optional<Projection> solve_lens(const SeenPoints& points, const Rows& rows) {
  if (rows.size() < 6) return std::nullopt;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const std::size_t i : rows) center += points.pixel_px[i] / static_cast<double>(rows.size());
  Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
  for (const std::size_t i : rows) {
    const Eigen::Vector2d pixel = (points.pixel_px[i] - center) / points.half_px;
    // What lies far out of the scene would outweigh all of it.
    const double weight = 1 / std::max(points.position[i].norm(), 1.0);
    const Eigen::Vector4d p = weight * points.position[i].homogeneous();
    const Eigen::Matrix4d square = p * p.transpose();
    normal.block<4, 4>(0, 0) += square;
    normal.block<4, 4>(4, 4) += square;
    normal.block<4, 4>(0, 8) -= pixel.x() * square;
    normal.block<4, 4>(4, 8) -= pixel.y() * square;
    normal.block<4, 4>(8, 8) += pixel.squaredNorm() * square;
  }
  normal.block<4, 4>(8, 0) = normal.block<4, 4>(0, 8).transpose();
  normal.block<4, 4>(8, 4) = normal.block<4, 4>(4, 8).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> eigen(normal);
  if (!(eigen.eigenvalues()(1) > least_relief * eigen.eigenvalues()(11))) return std::nullopt;
  const Eigen::Matrix<double, 12, 1> m = eigen.eigenvectors().col(0) / eigen.eigenvectors()(11, 0);
  const Eigen::Vector2d middle_px = center + points.half_px * Eigen::Vector2d(m(3), m(7));
  const Eigen::Vector3d g = m.segment<3>(8);
  Eigen::Matrix<double, 2, 3> a;
  a.row(0) = points.half_px * m.segment<3>(0).transpose() + center.x() * g.transpose();
  a.row(1) = points.half_px * m.segment<3>(4).transpose() + center.y() * g.transpose();
  return projection_of(middle_px, a, g);
}

std::optional<Projection> solve_parallel(const SeenPoints& points, const Rows& rows) {
  if (rows.size() < 4) return std::nullopt;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 2> target = Eigen::Matrix<double, 4, 2>::Zero();
  for (const std::size_t i : rows) {
    const double weight = 1 / std::max(points.position[i].norm(), 1.0);
    const Eigen::Vector4d p = weight * points.position[i].homogeneous();
    normal += p * p.transpose();
    target += weight * p * points.pixel_px[i].transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(normal);
  if (!(eigen.eigenvalues()(0) > least_relief * eigen.eigenvalues()(3))) return std::nullopt;
  const Eigen::Matrix<double, 4, 2> m = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                        eigen.eigenvectors().transpose() * target;
  return projection_of(m.row(3).transpose(), m.topRows<3>().transpose(), Eigen::Vector3d::Zero());
}

std::optional<Projection> solve_with_depth(const SeenPoints& points, std::span<const double> depth, const Rows& rows) {
  if (rows.size() < 4) return std::nullopt;
  std::vector<double> depths;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const std::size_t i : rows) {
    depths.push_back(depth[i]);
    center += points.pixel_px[i] / static_cast<double>(rows.size());
  }
  const double typical = median(std::move(depths));
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> target = Eigen::Matrix<double, 4, 3>::Zero();
  for (const std::size_t i : rows) {
    const Eigen::Vector2d pixel = (points.pixel_px[i] - center) / points.half_px;
    const double z = depth[i] / typical;
    const double weight = 1 / std::max(z, 0.1);  // Errors count in pixels, but a false depth near 0 not above all.
    const Eigen::Vector4d row = weight * Eigen::Vector4d(1, z * pixel.x(), z * pixel.y(), z);
    normal += row * row.transpose();
    target += weight * row * points.position[i].transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(normal);
  if (!(eigen.eigenvalues()(0) > least_relief * eigen.eigenvalues()(3))) return std::nullopt;
  const Eigen::Matrix<double, 4, 3> m = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                        eigen.eigenvectors().transpose() * target;
  // The view axis meets the picture where w + a u + b v is perpendicular to u and v.
  const double per_px = points.half_px * typical;
  Eigen::Matrix<double, 3, 2> across;
  across << m.row(1).transpose() / per_px, m.row(2).transpose() / per_px;
  const Eigen::Vector3d middle = m.row(3).transpose() / typical;
  const Eigen::Vector2d shift = (across.transpose() * across).ldlt().solve(-across.transpose() * middle);
  Projection out;
  out.axes = axes_of(across.col(0), across.col(1), middle + across * shift);
  const Eigen::Vector3d of_origin = -(out.axes * m.row(0).transpose());  // from the eye
  if (!(of_origin.z() > 0)) return std::nullopt;
  out.closeness = 1 / of_origin.z();
  out.scale = Eigen::Vector2d(1 / across.col(0).norm(), 1 / across.col(1).norm()) * out.closeness;
  out.slant = -out.closeness * out.scale.cwiseProduct(of_origin.head<2>());
  out.middle_px = center + shift - out.slant / out.closeness;
  return checked(out);
}

Rows spread(const SeenPoints& points, std::size_t count) {
  Rows rows;
  const std::size_t step = std::max<std::size_t>(1, (points.size() + count - 1) / count);
  for (std::size_t i = 0; i < points.size(); i += step) rows.push_back(i);
  return rows;
}

double score(const SeenPoints& points, const Rows& rows, const Projection& projection) {
  double sum = 0;
  for (const std::size_t i : rows)
    sum += score_of((projection.pixel_px(points.position[i]) - points.pixel_px[i]).norm());
  return sum / static_cast<double>(rows.size());
}

std::vector<Projection> random_starts(const SeenPoints& points, const LinearSolution& solution, std::size_t sample,
                                      std::size_t most) {
  const Rows judging = spread(points, judges);
  std::minstd_rand random;  // the same numbers in every run
  std::vector<std::pair<double, Projection>> found;
  for (int i = 0; i < samples; ++i) {
    Rows few;
    for (std::size_t k = 0; k < sample; ++k) few.push_back(random() % points.size());
    if (const std::optional<Projection> start = solution(points, few))
      found.emplace_back(score(points, judging, *start), *start);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Projection> starts;
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i) starts.push_back(found[i].second);
  return starts;
}

}  // namespace dermis::exr
