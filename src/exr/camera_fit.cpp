#include "exr/camera_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "exr/outliers.hpp"

namespace dermis::exr {
namespace {

using Projection = Camera::Projection;

constexpr std::size_t fewest_points = 16;
constexpr std::size_t points_of_start = 6;
constexpr double largest_rms_px = 0.5;       // half a pixel: a position may be anywhere in its pixel
constexpr double smallest_share = 0.5;       // of the points that must be kept
constexpr double largest_skew = 0.01;        // cosine between axes that should be perpendicular
constexpr double largest_stretch = 0.01;     // of the view axis, whose length should be 1
constexpr double largest_doubt = 0.01;       // standard error of an axis, relative
constexpr double relief_over_noise = 30;     // then noise in the columns biases the fit by less than (1/30)^2
constexpr double nearest_over_median = 0.1;  // nearer points weigh no more: a false depth near 0 would outweigh all

std::string text_of(double value) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  return buffer.data();
}

/// Pixel coordinates from -1 to 1, depth in medians, positions from their middle: what makes the fit well conditioned
/// wherever the scene lies.
struct Scale {
  double x0_px = 0;
  double y0_px = 0;
  double half_px = 0;
  double depth = 0;
  Eigen::RowVector3d position;
};

Scale scale_of(std::span<const SeenPoint> points) {
  const auto by_x = [](const SeenPoint& a, const SeenPoint& b) { return a.x_px < b.x_px; };
  const auto by_y = [](const SeenPoint& a, const SeenPoint& b) { return a.y_px < b.y_px; };
  const auto [left, right] = std::minmax_element(points.begin(), points.end(), by_x);
  const auto [top, bottom] = std::minmax_element(points.begin(), points.end(), by_y);
  std::vector<double> depths;
  std::array<std::vector<double>, 3> positions;
  for (const SeenPoint& point : points) {
    depths.push_back(point.depth);
    for (std::size_t k = 0; k < 3; ++k) positions[k].push_back(point.position[k]);
  }
  Scale scale;
  scale.x0_px = (left->x_px + right->x_px) / 2;
  scale.y0_px = (top->y_px + bottom->y_px) / 2;
  scale.half_px = std::max({right->x_px - left->x_px, bottom->y_px - top->y_px, 1.0}) / 2;
  scale.depth = median(depths);
  scale.position = {median(positions[0]), median(positions[1]), median(positions[2])};
  return scale;
}

/// The linear system of all points: design * coefficients = target, one row per point, weighted so that a row's error
/// is in pixels times the length of u.
struct System {
  Eigen::Matrix<double, Eigen::Dynamic, 4> design;
  Eigen::Matrix<double, Eigen::Dynamic, 3> target;
  Eigen::VectorXd weight;
};

System system_of(Projection projection, std::span<const SeenPoint> points, const Scale& scale) {
  const auto n = static_cast<Eigen::Index>(points.size());
  System system{Eigen::MatrixXd(n, 4), Eigen::MatrixXd(n, 3), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const SeenPoint& point = points[static_cast<std::size_t>(i)];
    const double x = (point.x_px - scale.x0_px) / scale.half_px;
    const double y = (point.y_px - scale.y0_px) / scale.half_px;
    const double z = point.depth / scale.depth;
    const Eigen::RowVector3d position(point.position[0], point.position[1], point.position[2]);
    const bool perspective = projection == Projection::perspective;
    const double weight = perspective ? 1 / std::max(z, nearest_over_median) : 1;
    const Eigen::RowVector4d row =
        perspective ? Eigen::RowVector4d(1, z * x, z * y, z) : Eigen::RowVector4d(1, x, y, z);
    system.design.row(i) = weight * row;
    system.target.row(i) = weight * (position - scale.position);
    system.weight(i) = weight;
  }
  return system;
}

System rows_of(const System& system, const std::vector<Eigen::Index>& kept) {
  return {system.design(kept, Eigen::all), system.target(kept, Eigen::all), system.weight(kept)};
}

struct Solution {
  Eigen::Matrix<double, 4, 3> coefficients;
  double relief = 0;  ///< smallest singular value of the design per point: 0 if its columns depend on each other
};

Solution solve(const System& system) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system.design);
  const Eigen::Matrix4d r = qr.matrixQR().topRows<4>().triangularView<Eigen::Upper>();
  const Eigen::Vector4d singular = Eigen::JacobiSVD<Eigen::Matrix4d>(r).singularValues();
  return {qr.solve(Eigen::MatrixXd(system.target)), singular(3) / std::sqrt(static_cast<double>(system.design.rows()))};
}

/// The camera's axes in world space, per pixel and per unit of depth.
struct Axes {
  Eigen::Vector3d right, down;  ///< u and v
  Eigen::Vector3d forward;      ///< w at the middle (x0, y0) of the pixels, or n

  double pixel() const { return std::sqrt(right.norm() * down.norm()); }
};

Axes axes_of(Projection projection, const Solution& solution, const Scale& scale) {
  const double per_px = projection == Projection::perspective ? scale.half_px * scale.depth : scale.half_px;
  return {solution.coefficients.row(1).transpose() / per_px, solution.coefficients.row(2).transpose() / per_px,
          solution.coefficients.row(3).transpose() / scale.depth};
}

double cosine(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::abs(a.dot(b)) / (a.norm() * b.norm()); }

/// Fits, looks which points are off, and fits again without them.
class Fitting {
 public:
  Fitting(Projection projection, std::span<const SeenPoint> points)
      : projection_(projection), scale_(scale_of(points)), system_(system_of(projection, points, scale_)) {
    kept_ = spread(points.size(), points.size());
  }

  FitOutcome run(double depth_rounding) {
    kept_ = within_limit(errors_px(system_, best_start()));
    for (int i = 0; i < most_refits; ++i) {
      solution_ = solve(rows_of(system_, kept_));
      if (!(solution_.relief >= relief_over_noise * depth_rounding)) {
        return {.fit = {}, .why_not = "all points lie on one plane"};
      }
      axes_ = axes_of(projection_, solution_, scale_);
      if (!(axes_.pixel() > 0)) return {.fit = {}, .why_not = "the positions are all the same"};
      errors_px_ = errors_px(system_, solution_);
      std::vector<Eigen::Index> kept = within_limit(errors_px_);
      if (kept == kept_) break;
      kept_ = std::move(kept);
    }
    return judge();
  }

 private:
  std::vector<double> errors_px(const System& system, const Solution& solution) const {
    const Axes axes = axes_of(projection_, solution, scale_);
    const double unit = projection_ == Projection::perspective ? scale_.depth * axes.pixel() : axes.pixel();
    const Eigen::VectorXd errors = (system.target - system.design * solution.coefficients).rowwise().norm() / unit;
    std::vector<double> out(errors.begin(), errors.end());
    std::transform(out.begin(), out.end(), out.begin(), error_or_huge);
    return out;
  }

  /// The fit to few points, or to all, that has the least median error: false points far off would bend a fit to all of
  /// them.
  Solution best_start() const {
    const auto n = static_cast<std::size_t>(system_.design.rows());
    const System judges = rows_of(system_, spread(n, points_to_judge_start));
    Solution best = solve(system_);
    double least = median(errors_px(judges, best));
    std::minstd_rand random;  // the same numbers in every run
    for (int i = 0; i < starts; ++i) {
      std::vector<Eigen::Index> few;
      for (std::size_t k = 0; k < points_of_start; ++k) few.push_back(static_cast<Eigen::Index>(random() % n));
      const Solution solution = solve(rows_of(system_, few));
      const double error = median(errors_px(judges, solution));
      if (error < least) {
        least = error;
        best = solution;
      }
    }
    return best;
  }

  /// The points that are not off. Never too few to fit.
  std::vector<Eigen::Index> within_limit(const std::vector<double>& errors) const {
    const double limit = limit_px(errors);
    std::vector<Eigen::Index> kept;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i] <= limit) kept.push_back(static_cast<Eigen::Index>(i));
    }
    return kept.size() < fewest_points ? kept_ : kept;
  }

  double rms_px() const {
    double sum = 0;
    for (const Eigen::Index i : kept_) {
      sum += errors_px_[static_cast<std::size_t>(i)] * errors_px_[static_cast<std::size_t>(i)];
    }
    return std::sqrt(sum / static_cast<double>(kept_.size()));
  }

  double largest_units() const {
    double largest = 0;
    for (const Eigen::Index i : kept_) {
      const auto difference = system_.target.row(i) - system_.design.row(i) * solution_.coefficients;
      largest = std::max(largest, difference.norm() / system_.weight(i));
    }
    return largest;
  }

  FitOutcome judge() const {
    const auto no = [](std::string why) { return FitOutcome{.fit = {}, .why_not = std::move(why)}; };
    const double rms = rms_px();
    const double typical = median(errors_px_);
    const auto enough = smallest_share * static_cast<double>(errors_px_.size());
    // Negated, so that a NaN is refused.
    if (!(rms <= largest_rms_px) || !(static_cast<double>(kept_.size()) >= enough)) {
      return no("off by " + text_of(typical) + " px in the median");
    }
    const double doubt = rms / (solution_.relief * std::sqrt(static_cast<double>(kept_.size()))) / scale_.half_px;
    if (!(doubt <= largest_doubt)) {
      return no("too flat a scene, the axes are only known to " + text_of(100 * doubt) + " %");
    }
    return projection_ == Projection::perspective ? perspective(rms) : orthographic(rms);
  }

  FitOutcome perspective(double rms) const {
    // The view axis meets the picture where w + a u + b v is perpendicular to u and v.
    Eigen::Matrix<double, 3, 2> across;
    across << axes_.right, axes_.down;
    const Eigen::Vector2d shift = (across.transpose() * across).ldlt().solve(-across.transpose() * axes_.forward);
    const Eigen::Vector3d view = axes_.forward + across * shift;
    return checked(view,
                   Camera::perspective(1 / axes_.right.norm(), 1 / axes_.down.norm(), scale_.x0_px + shift(0),
                                       scale_.y0_px + shift(1)),
                   rms);
  }

  FitOutcome orthographic(double rms) const {
    return checked(axes_.forward, Camera::orthographic(1 / axes_.right.norm(), 1 / axes_.down.norm()), rms);
  }

  FitOutcome checked(const Eigen::Vector3d& view, const Camera& camera, double rms) const {
    const double skew =
        std::max({cosine(axes_.right, axes_.down), cosine(axes_.right, view), cosine(axes_.down, view)});
    if (!(skew <= largest_skew)) {
      return {.fit = {}, .why_not = "axes with a cosine of " + text_of(skew) + " between them"};
    }
    if (!(std::abs(view.norm() - 1) <= largest_stretch)) {
      return {.fit = {}, .why_not = "depth is " + text_of(1 / view.norm()) + " times that of the positions"};
    }
    // Positions are fitted from their middle.
    const bool is_perspective = projection_ == Projection::perspective;
    const Eigen::Vector3d eye =
        is_perspective ? Eigen::Vector3d((scale_.position + solution_.coefficients.row(0)).transpose()) : view;
    return {
        .fit =
            CameraFit{
                .camera = camera, .eye = {eye(0), eye(1), eye(2)}, .rms_px = rms, .residual_units = largest_units()},
        .why_not = {}};
  }

  Projection projection_;
  Scale scale_;
  System system_;
  std::vector<Eigen::Index> kept_;
  Solution solution_;
  Axes axes_;
  std::vector<double> errors_px_;
};

}  // namespace

FitOutcome fit_camera(Projection projection, std::span<const SeenPoint> points, double depth_rounding) {
  if (points.size() < fewest_points) {
    return {.fit = {}, .why_not = "only " + std::to_string(points.size()) + " pixels that are not background"};
  }
  return Fitting(projection, points).run(depth_rounding);
}

}  // namespace dermis::exr
