#include "exr/projection_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "exr/median.hpp"
#include "exr/projection_start.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t fewest_points = 16;
constexpr int most_steps = 60;
constexpr double tukey_width = 4.685;  // standard deviations: 95 % as good as least squares where all points are true
constexpr double least_step = 0.03;    // standard errors, and of the noise: smaller steps change nothing

// The parameters of a projection, by how they change it.
enum Parameter { turn_x, turn_y, turn_z, middle_x, middle_y, log_scale_x, log_scale_y, near, slant_x, slant_y };
constexpr int parameters = 10;
using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

Projection changed(const Projection& from, const Vector& by) {
  Projection to = from;
  const Eigen::Vector3d turn = by.segment<3>(turn_x);
  const double angle = turn.norm();
  if (angle > 0) to.axes = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * from.axes;
  to.middle_px += by.segment<2>(middle_x);
  to.scale = to.scale.cwiseProduct(by.segment<2>(log_scale_x).array().exp().matrix());
  to.closeness += by(near);
  to.slant += by.segment<2>(slant_x);
  if (to.closeness < 0) {  // the same projection with the axis the other way
    to.axes.row(2) = -to.axes.row(2);
    to.closeness = -to.closeness;
    to.slant = -to.slant;
  }
  return to;
}

/// The errors of a point, in pixels: right, down, and in depth as if that were seen from the side.
struct Errors {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, parameters> slope = Eigen::Matrix<double, 3, parameters>::Zero();
};

/// How (X, Y, Z) changes with a turn: its cross product.
Eigen::Matrix3d turned(const Eigen::Vector3d& p) {
  Eigen::Matrix3d m;
  m << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  return m;
}

/// How far points reach across the plane nearest to them, and along it, without the outer ones.
std::array<double, 2> extents_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) middle += point / static_cast<double>(points.size());
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) squares += (point - middle) * (point - middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(squares);
  std::array<double, 2> extents{};
  for (const Eigen::Index k : {0, 1}) {
    std::vector<double> along;
    along.reserve(points.size());
    for (const Eigen::Vector3d& point : points) along.push_back(eigen.eigenvectors().col(2 * k).dot(point));
    std::sort(along.begin(), along.end());
    const std::size_t outer = along.size() / 50;
    extents[static_cast<std::size_t>(k)] = along[along.size() - 1 - outer] - along[outer];
  }
  return extents;
}

class Fitting {
 public:
  Fitting(const SeenPoints& points, Projection start, const FitModel& model)
      : points_(points), model_(model), now_(std::move(start)), uses_depth_(model.depth != FitModel::Depth::unused) {
    if (model.is_parallel) {
      now_.closeness = 0;
      now_.slant.setZero();
    }
    // Medians of the length of 2 and of 3 normal values.
    typical_ = uses_depth_ ? 1.5382 : 1.1774;
  }

  std::optional<Fit> run() {
    if (points_.size() < fewest_points) return std::nullopt;
    find_noise();
    for (int step = 0; step < most_steps; ++step) {
      const double noise_before = noise_px_;
      const bool has_moved = improve();
      find_noise();
      if (!has_moved && std::abs(noise_px_ / noise_before - 1) < least_step) break;
    }
    return judged();
  }

 private:
  bool is_free(int parameter) const { return !model_.is_parallel || parameter < near; }

  Errors errors_of(std::size_t i, bool with_slope) const {
    const Eigen::Vector3d p = now_.axes * points_.position[i];
    const double nearness = 1 + now_.closeness * p.z();
    Errors errors;
    if (!(nearness > 1e-6)) {
      errors.value.setConstant(1e9);
      return errors;
    }
    const Eigen::Vector2d seen = (now_.scale.cwiseProduct(p.head<2>()) + now_.slant * p.z()) / nearness;
    errors.value.head<2>() = now_.middle_px + seen - points_.pixel_px[i];
    if (with_slope) {
      const Eigen::Matrix3d turn = turned(p);
      for (int k = 0; k < 2; ++k) {
        errors.slope.block<1, 3>(k, turn_x) =
            (now_.scale(k) * turn.row(k) + (now_.slant(k) - seen(k) * now_.closeness) * turn.row(2)) / nearness;
        errors.slope(k, middle_x + k) = 1;
        errors.slope(k, log_scale_x + k) = now_.scale(k) * p(k) / nearness;
        errors.slope(k, near) = -seen(k) * p.z() / nearness;
        errors.slope(k, slant_x + k) = p.z() / nearness;
      }
    }
    if (uses_depth_) add_depth(i, p, with_slope, errors);
    return errors;
  }

  /// From the eye the point lies at (X - slant / (scale closeness), 1 / closeness + Z).
  void add_depth(std::size_t i, const Eigen::Vector3d& p, bool with_slope, Errors& errors) const {
    const double per_unit = px_per_unit_[i];
    const double closeness = now_.closeness;
    const Eigen::Vector2d aside = now_.slant.cwiseQuotient(now_.scale) / closeness;
    const Eigen::Vector3d from_eye(p.x() - aside.x(), p.y() - aside.y(), p.z() + 1 / closeness);
    const double length = from_eye.norm();
    const bool is_distance = model_.depth == FitModel::Depth::distance;
    const Eigen::RowVector3d direction =
        is_distance ? Eigen::RowVector3d(from_eye.transpose() / length) : Eigen::RowVector3d(0, 0, 1);
    // What a depth is off by counts less where its format rounds it more than the position is.
    const double weight = 1 / std::sqrt(1 + rounding_of_depth(i, per_unit) / variance(i, per_unit));
    errors.value.z() = weight * per_unit * ((is_distance ? length : from_eye.z()) - model_.depths[i]);
    if (!with_slope) return;
    Eigen::Matrix<double, 3, parameters> slope = Eigen::Matrix<double, 3, parameters>::Zero();
    slope.block<3, 3>(0, turn_x) = turned(p);
    slope(2, near) = -1 / (closeness * closeness);
    for (int k = 0; k < 2; ++k) {
      slope(k, log_scale_x + k) = aside(k);
      slope(k, near) = aside(k) / closeness;
      slope(k, slant_x + k) = -1 / (now_.scale(k) * closeness);
    }
    errors.slope.row(2) = weight * per_unit * direction * slope;
  }

  /// Variances on the picture, px^2: of the position with the noise, and of the depth.
  double variance(std::size_t i, double per_unit) const {
    const double rounding = points_.rounding[i] * per_unit;
    return noise_px_ * noise_px_ + rounding * rounding;
  }

  double rounding_of_depth(std::size_t i, double per_unit) const {
    const double rounding = points_.depth_rounding * model_.depths[i] * per_unit;
    return rounding * rounding;
  }

  /// As it was when the noise was found last: a projection must not be able to make its errors count less.
  double variance(std::size_t i) const { return variance(i, px_per_unit_[i]); }

  /// The noise that is left in the median when the rounding is taken away; never 0, for errors of rounding are no
  /// longer than their standard deviation by much.
  void find_noise() {
    std::vector<double> lengths;
    std::vector<double> roundings;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      px_per_unit_[i] = now_.px_per_unit(points_.position[i]);
      lengths.push_back(errors_of(i, false).value.norm());
      roundings.push_back(points_.rounding[i] * px_per_unit_[i]);
    }
    const double all = median(std::move(lengths)) / typical_;
    const double rounding = median(std::move(roundings));
    excess_px_ = std::sqrt(std::max(all * all - rounding * rounding, 0.0));
    noise_px_ = std::max({excess_px_, 0.3 * rounding, 1e-7});
  }

  /// Tukey's biweight of an error, by its square in standard deviations.
  static double weight_of(double squared) {
    const double u = squared / (tukey_width * tukey_width);
    return u < 1 ? (1 - u) * (1 - u) : 0;
  }

  static double cost_of(double squared) {
    const double u = squared / (tukey_width * tukey_width);
    return u < 1 ? 1 - (1 - u) * (1 - u) * (1 - u) : 1;
  }

  double cost() const {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      sum += cost_of(errors_of(i, false).value.squaredNorm() / variance(i));
    }
    return sum;
  }

  struct Normal {
    Matrix matrix = Matrix::Zero();
    Vector gradient = Vector::Zero();
    std::array<Vector, patches_per_side * patches_per_side> by_patch;
    double cost = 0;
    double squares = 0;
    double weights = 0;
  };

  Normal normal() const {
    Normal out;
    out.by_patch.fill(Vector::Zero());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Errors errors = errors_of(i, true);
      const double at = variance(i);
      const double squared = errors.value.squaredNorm() / at;
      const double weight = weight_of(squared);
      out.cost += cost_of(squared);
      if (weight == 0) continue;
      const Vector gradient = (weight / at) * (errors.slope.transpose() * errors.value);
      // Eigen's product of matrices of any size would take most of the time.
      out.matrix += (weight / at) * errors.slope.transpose().lazyProduct(errors.slope);
      out.gradient += gradient;
      out.by_patch[points_.patch[i]] += gradient;
      out.squares += weight * squared;
      out.weights += weight;
    }
    for (int k = 0; k < parameters; ++k) {
      if (is_free(k)) continue;
      out.matrix.row(k).setZero();
      out.matrix.col(k).setZero();
      out.matrix(k, k) = 1;
      out.gradient(k) = 0;
      for (Vector& gradient : out.by_patch) gradient(k) = 0;
    }
    return out;
  }

  /// A step of Levenberg and Marquardt; false if none that matters makes the fit better.
  bool improve() {
    const Normal all = normal();
    const Projection from = now_;
    // Columns of one length, as the parameters have many units.
    const Vector unit = all.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Matrix scaled = unit.asDiagonal() * all.matrix * unit.asDiagonal();
    for (int attempt = 0; attempt < 8; ++attempt) {
      const Matrix damped = scaled + damping_ * Matrix::Identity();
      const Vector step = -(unit.asDiagonal() * damped.ldlt().solve(unit.asDiagonal() * all.gradient));
      now_ = changed(from, step);
      const double after = step.allFinite() ? cost() : HUGE_VAL;
      if (after < all.cost) {
        damping_ = std::max(damping_ / 10, 1e-13);
        return step.dot(all.matrix * step) > least_step * least_step;
      }
      damping_ *= 10;
    }
    now_ = from;
    return false;
  }

  /// The covariance of the parameters: that of errors which depend on each other within a patch.
  static Matrix covariance(const Normal& all) {
    const Vector unit = all.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix(unit.asDiagonal() * all.matrix * unit.asDiagonal()));
    const Vector inverse = eigen.eigenvalues().cwiseMax(1e-15).cwiseInverse();
    const Matrix bread = unit.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
                         eigen.eigenvectors().transpose() * unit.asDiagonal();
    Matrix meat = Matrix::Zero();
    int used = 0;
    for (const Vector& gradient : all.by_patch) {
      meat += gradient * gradient.transpose();
      used += gradient.isZero(0) ? 0 : 1;
    }
    const double few = used > parameters ? used / static_cast<double>(used - parameters) : HUGE_VAL;
    const Matrix sandwich = few * (bread * meat * bread);
    const Matrix plain = (all.squares / std::max(all.weights, 1.0)) * bread;
    return plain + sandwich;
  }

  std::optional<Fit> judged() const {
    Fit fit;
    fit.projection = now_;
    fit.noise_px = excess_px_;
    std::vector<double> off;
    std::vector<double> along;
    std::vector<Eigen::Vector3d> kept;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d errors = errors_of(i, false).value;
      off.push_back(errors.head<2>().norm());
      if (weight_of(errors.squaredNorm() / variance(i)) == 0) continue;
      along.push_back(now_.axes.row(2).dot(points_.position[i]));
      kept.push_back(points_.position[i]);
      fit.residual_units =
          std::max(fit.residual_units, errors.norm() / now_.px_per_unit(points_.position[i]) * points_.unit);
    }
    for (const double px : off) fit.score += score_of(px) / static_cast<double>(off.size());
    fit.off_px = median(std::move(off));
    fit.share = static_cast<double>(along.size()) / static_cast<double>(points_.size());
    if (along.size() < fewest_points) return std::nullopt;
    const std::array<double, 2> extent = extents_of(kept);
    fit.relief = extent[0] / extent[1];
    fit.relief_px = extent[0] * now_.px_per_unit(Eigen::Vector3d::Zero());
    std::sort(along.begin(), along.end());
    const double half_extent = (along[along.size() - 1 - along.size() / 50] - along[along.size() / 50]) / 2;

    const Matrix spread = covariance(normal());
    const auto error_of = [&spread](const Vector& slope) { return std::sqrt(slope.dot(spread * slope)); };
    fit.foreshortening = now_.closeness * half_extent;
    fit.foreshortening_doubt = error_of(Vector::Unit(near)) * half_extent;
    for (int k = 0; k < 2; ++k) {
      Vector of_scale = Vector::Unit(log_scale_x + k);
      if (!model_.is_parallel) {
        of_scale(near) = -1 / now_.closeness;
        Vector of_center = Vector::Unit(middle_x + k);
        of_center(slant_x + k) = 1 / now_.closeness;
        of_center(near) = -now_.slant(k) / (now_.closeness * now_.closeness);
        const double focal_px = now_.focal_px()(k);
        fit.scale_doubt = std::max(fit.scale_doubt, error_of(of_center) * points_.half_px / (focal_px * focal_px));
      }
      fit.scale_doubt = std::max(fit.scale_doubt, error_of(of_scale));
    }
    if (!(fit.scale_doubt > 0)) fit.scale_doubt = HUGE_VAL;  // also a NaN
    return fit;
  }

  const SeenPoints& points_;
  const FitModel& model_;
  Projection now_;
  bool uses_depth_;
  double typical_;
  std::vector<double> px_per_unit_ = std::vector<double>(points_.size());
  double noise_px_ = 0;   ///< that errors are weighed by
  double excess_px_ = 0;  ///< beyond the rounding
  double damping_ = 1e-6;
};

}  // namespace

std::optional<Fit> fit_projection(const SeenPoints& points, const Projection& start, const FitModel& model) {
  return Fitting(points, start, model).run();
}

}  // namespace dermis::exr
