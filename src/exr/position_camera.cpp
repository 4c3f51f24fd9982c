#include "exr/position_camera.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "exr/depth_line.hpp"
#include "exr/depth_type.hpp"
#include "exr/frame_match.hpp"
#include "exr/median.hpp"
#include "exr/message_text.hpp"
#include "exr/projection_fit.hpp"
#include "exr/projection_start.hpp"
#include "exr/seen_points.hpp"

namespace dermis::exr {
namespace {

constexpr double most_noise_px = 0.5;  // a disc of confusion of 1 px radius, or a point anywhere in 1.7 px
constexpr double least_share = 0.6;    // of the points that must be true
constexpr double errors_allowed = 5;   // standard errors
constexpr double limit_fine = 0.001;   // of the focal length
constexpr double limit_coarse = 0.005;
constexpr double most_off = 0.05;         // of half the picture: with more than that rounding explains anything
constexpr double nearly_all = 0.95;       // of the points; if more are false another fit may show more
constexpr double as_good = 1.05;          // times the error of another fit: medians of thousands are known to 2 %
constexpr double plane = 1e-3;            // thickness of points over their extent
constexpr double nearly_parallel = 1e-3;  // half the change of size from the front of the scene to its back
constexpr double least_relief = 0.01;
constexpr double least_relief_over_noise = 10;
constexpr std::size_t refined_starts = 3;
constexpr std::size_t few = 2000;   // points that a fit is sought with before all refine it
constexpr double known_well = 0.1;  // of the doubt that is allowed: all points need not refine that

bool is_good(const std::optional<Fit>& fit, double half_px) {
  return fit && fit->share >= least_share && fit->noise_px <= most_noise_px && fit->off_px <= most_off * half_px;
}

/// A depth pass as it would be if its values were of this type, in units of the points.
FitModel model_with(const SeenPoints& points, const DepthType& type) {
  FitModel model;
  model.depth = type.kind == DepthKind::distance ? FitModel::Depth::distance : FitModel::Depth::along_axis;
  for (const float value : points.depth) {
    const double depth = static_cast<double>(unfolded(value, type)) / points.unit;
    model.depths.push_back(std::isfinite(depth) ? depth : 1e9);  // no point of a scene
  }
  return model;
}

template <typename Value>
std::vector<Value> every(const std::vector<Value>& values, std::size_t step) {
  std::vector<Value> out;
  for (std::size_t i = 0; i < values.size(); i += step) out.push_back(values[i]);
  return out;
}

SeenPoints every(const SeenPoints& points, std::size_t step) {
  SeenPoints out = points;
  out.position = every(points.position, step);
  out.pixel_px = every(points.pixel_px, step);
  out.rounding = every(points.rounding, step);
  out.patch = every(points.patch, step);
  out.depth = every(points.depth, step);
  return out;
}

FitModel every(const FitModel& model, std::size_t step) {
  FitModel out = model;
  out.depths = every(model.depths, step);
  return out;
}

/// Searches the projections that see points, with depths of a type or without.
class Search {
 public:
  /// `limit`: how far off the focal length may be.
  Search(const SeenPoints& points, double limit)
      : points_(points),
        well_known_(known_well * limit / errors_allowed),
        all_(spread(points, points.size())),
        step_(std::max<std::size_t>(points.size() / few, 1)),
        few_(every(points, step_)) {}

  std::optional<Fit> free() const {
    const FitModel model;
    std::optional<Fit> fit = free_of_few(model);
    // Nearly parallel rays leave the direction of the axis to the noise, in which the lens cannot be told.
    if (fit && fit->foreshortening < nearly_parallel) fit = fit_projection(few_, as_parallel(fit->projection), model);
    return refined(fit, model);
  }

  /// Parallel rays, from a linear solution of all points or from some that are chosen at random.
  std::optional<Fit> parallel() const {
    const FitModel model{.is_parallel = true};
    std::optional<Fit> best;
    if (const auto start = solve_parallel(points_, all_)) best = fit_projection(few_, *start, model);
    if (!is_complete(best)) refine(best, solve_parallel, 5, model);
    return best;
  }

  std::optional<Fit> with_depth(const FitModel& model, const std::optional<Fit>& before) const {
    return refined(with_depth_of_few(model, every(model, step_), before), model);
  }

 private:
  /// The fit to all points that begins at one to a few, unless these do.
  std::optional<Fit> refined(const std::optional<Fit>& fit, const FitModel& model) const {
    if (!fit || step_ == 1 || (is_complete(fit) && fit->scale_doubt <= well_known_)) return fit;
    return fit_projection(points_, fit->projection, model);
  }

  /// From linear solutions of all points; if that leads nowhere, of some that are chosen at random.
  std::optional<Fit> free_of_few(const FitModel& model) const {
    std::vector<std::pair<double, Projection>> starts;
    for (const auto& start : {solve_lens(points_, all_), solve_parallel(points_, all_)})
      if (start) starts.emplace_back(score(points_, all_, *start), *start);
    std::sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::optional<Fit> best;
    for (const auto& start : starts)
      if (!is_complete(best)) keep_better(best, fit_projection(few_, start.second, model));
    if (!is_complete(best)) refine(best, solve_lens, 7, model);
    if (!is_good(best, points_.half_px)) refine(best, solve_parallel, 5, model);
    return best;
  }

  std::optional<Fit> with_depth_of_few(const FitModel& model, const FitModel& few_model,
                                       const std::optional<Fit>& before) const {
    std::optional<Fit> best;
    const LinearSolution solution = [&model](const SeenPoints& points, const Rows& rows) {
      return solve_with_depth(points, model.depths, rows);
    };
    if (const auto start = solution(points_, all_)) best = fit_projection(few_, *start, few_model);
    if (!is_complete(best) && before && before->projection.closeness > 0)
      keep_better(best, fit_projection(few_, before->projection, few_model));
    if (!is_complete(best) && !before) refine(best, solution, 5, few_model);
    return best;
  }

  bool is_complete(const std::optional<Fit>& fit) const {
    return is_good(fit, points_.half_px) && fit->share >= nearly_all;
  }

  static void keep_better(std::optional<Fit>& best, std::optional<Fit> other) {
    if (other && (!best || other->score < best->score)) best = std::move(other);
  }

  void refine(std::optional<Fit>& best, const LinearSolution& solution, std::size_t sample,
              const FitModel& model) const {
    for (const Projection& start : random_starts(points_, solution, sample, refined_starts)) {
      keep_better(best, fit_projection(few_, start, model));
      if (is_complete(best)) return;
    }
  }

  const SeenPoints& points_;
  double well_known_;  ///< of Fit::scale_doubt
  Rows all_;
  std::size_t step_;
  SeenPoints few_;
};

class Finding {
 public:
  Finding(const Picture& picture, const Roles& roles, const std::optional<DepthType>& told)
      : picture_(picture), roles_(roles), told_(told), points_(seen_points(picture, roles)) {
    coarse_position_ = coarseness(picture, roles[Role::position]);
    const bool is_coarse = !coarse_position_.empty() || picture.compression() == "pxr24";
    limit_ = is_coarse ? limit_coarse : limit_fine;
  }

  PositionCamera run() {
    if (points_.size() < 16) {
      return no(points_.size() == 0 ? "no pixel that shows a surface"
                                    : "only " + std::to_string(points_.size()) + " pixels that are not background");
    }
    const Search search(points_, limit_);
    free_ = search.free();
    if (is_good(free_) && is_known(*free_) && !may_be_parallel(search.parallel(), *free_)) {
      is_parallel_ = false;
      fit_ = free_;
    } else if (is_good(free_)) {
      fit_ = parallel_fit();
      is_parallel_ = fit_.has_value();
      // Parallel rays look the same from both ends; worlds are right-handed unless depth tells otherwise.
      if (is_parallel_) forward_sign_ = fit_->projection.axes.determinant() > 0 ? 1 : -1;
    }
    if (has_depth() && is_parallel_) recognise_parallel_depth();
    if (has_depth() && !is_parallel_) recognise_depth(search);
    if (!fit_) return no(reason());
    return {found(), {}};
  }

 private:
  static PositionCamera no(std::string why) { return {{}, std::move(why)}; }

  bool has_depth() const { return !points_.depth.empty(); }

  bool is_good(const std::optional<Fit>& fit) const { return exr::is_good(fit, points_.half_px); }

  /// A plane is seen alike by many cameras: where the points that agree lie on one, or on what noise makes of one, no
  /// doubt that is computed from them tells how wrong the fit may be.
  bool is_known(const Fit& fit) const {
    const double noise_px = std::max(fit.noise_px, fit.off_px);
    const bool is_plane = fit.relief < least_relief || fit.relief_px < least_relief_over_noise * noise_px;
    return !is_plane && errors_allowed * fit.scale_doubt <= limit_;
  }

  /// Parallel rays, where no lens that the points allow would change their size by more than the limit.
  std::optional<Fit> parallel_fit() const {
    if (!(free_->foreshortening + errors_allowed * free_->foreshortening_doubt <= limit_)) return std::nullopt;
    std::optional<Fit> fit = fit_projection(points_, as_parallel(free_->projection), {.is_parallel = true});
    return may_be_parallel(fit, *free_) && is_known(*fit) ? fit : std::nullopt;
  }

  /// True if parallel rays show the points as well as another fit does, and as many: a wall across the view, which is
  /// most of a picture, looks the same through a lens, but what stands before it does not.
  bool may_be_parallel(const std::optional<Fit>& parallel, const Fit& other) const {
    return is_good(parallel) && parallel->off_px <= as_good * other.off_px && as_good * parallel->share >= other.share;
  }

  /// True if a lens that was found with depths might be parallel rays, to which depths say nothing, and that would
  /// matter.
  bool is_ambiguous(const Fit& lens) const {
    if (!(lens.foreshortening > limit_)) return false;
    return may_be_parallel(fit_projection(points_, as_parallel(lens.projection), {.is_parallel = true}), lens);
  }

  std::vector<DepthType> types_to_try() const {
    if (told_ && told_->kind == DepthKind::normalized) return {*told_};
    const bool is_negative = median({points_.depth.begin(), points_.depth.end()}) < 0;
    std::vector<DepthType> types = {
        {DepthKind::z, is_negative}, {DepthKind::distance, is_negative}, {DepthKind::inverse, is_negative}};
    if (told_) types.insert(types.begin(), *told_);
    return types;
  }

  /// The type whose fit with the depths has the least noise, if there is one that agrees with the positions.
  void recognise_depth(const Search& search) {
    std::optional<Fit> best;
    for (const DepthType& type : types_to_try()) {
      const std::optional<Fit> fit = search.with_depth(model_with(points_, type), free_);
      if (!is_good(fit) || !is_known(*fit) || !agrees(*fit) || is_ambiguous(*fit)) continue;
      // Through a long lens one type hardly differs from another: the first one stands where none is clearly better.
      if (!best || as_good * fit->noise_px < best->noise_px) {
        best = fit;
        type_ = type;
      }
    }
    if (best) fit_ = best;
  }

  /// True if a fit with depths shows the points where one without them does, and has its focal length.
  bool agrees(const Fit& fit) const {
    if (!is_good(free_)) return true;
    const Eigen::Vector2d ratio = fit.projection.focal_px().cwiseQuotient(free_->projection.focal_px());
    const double doubt = errors_allowed * std::hypot(fit.scale_doubt, free_->scale_doubt);
    return !(ratio.array().log().abs().maxCoeff() > doubt + limit_);
  }

  std::string reason() const {
    std::string why;
    if (free_ && !is_good(free_)) {
      why = "off by " + short_text(free_->off_px) + " px in the median";
    } else if (!free_ || is_flat()) {
      why = "all points on one plane";
    } else {
      why = "too flat for its distance, the focal length would be known to " +
            short_text(std::min(100 * errors_allowed * free_->scale_doubt, 999.0)) + " % only";
    }
    if (points_.unit == 1 && points_.position[0].isZero(0) && points_.position.back().isZero(0))
      why = "positions that are all the same";
    for (const Role role : {Role::position, Role::depth}) {
      const std::string coarse = roles_.has(role) ? coarseness(picture_, roles_[role]) : "";
      if (!coarse.empty()) why += "; " + coarse;
    }
    return why;
  }

  /// True if the points that the fit shows lie on one plane.
  bool is_flat() const {
    std::vector<Eigen::Vector3d> shown;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector2d off_px = free_->projection.pixel_px(points_.position[i]) - points_.pixel_px[i];
      if (off_px.norm() <= errors_allowed * free_->off_px + 1e-3) shown.push_back(points_.position[i]);
    }
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : shown) middle += p / static_cast<double>(shown.size());
    for (const Eigen::Vector3d& p : shown) spread += (p - middle) * (p - middle).transpose();
    const Eigen::Vector3d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
    return std::sqrt(std::max(squares(0), 0.0)) <= plane * std::sqrt(squares(1));
  }

  FoundCamera found() const {
    const Projection& projection = fit_->projection;
    FoundCamera out;
    out.source = type_ ? "position and depth" : "position";
    out.residual_units = fit_->residual_units;
    out.doubt = fit_->scale_doubt;
    if (is_parallel_) {
      const Eigen::Vector3d forward = forward_sign_ * projection.axes.row(2).transpose();
      const Eigen::Vector2d scale = projection.scale / points_.unit;
      out.camera = Camera::orthographic(scale.x(), scale.y());
      out.eye = {forward.x(), forward.y(), forward.z()};
    } else {
      const Eigen::Vector2d focal = projection.focal_px();
      const Eigen::Vector2d center = projection.center_px();
      out.camera = Camera::perspective(focal.x(), focal.y(), center.x(), center.y());
      const Eigen::Vector3d eye = points_.origin + points_.unit * projection.eye();
      out.eye = {eye.x(), eye.y(), eye.z()};
    }
    if (type_) out.depth_type = *type_;
    out.world_to_camera = world_to_camera();
    add_depth(out);
    warn_of_aspect(out);
    return out;
  }

  /// A lens is at the origin of its axes. Parallel rays have theirs at the upper left corner of the picture, where
  /// their camera has pixel 0, and at the depth of the axis.
  std::array<double, 12> world_to_camera() const {
    const Projection& projection = fit_->projection;
    Eigen::Matrix3d turn = projection.axes;
    Eigen::Vector3d origin;  // of world space
    if (is_parallel_) {
      turn.row(2) *= forward_sign_;
      const Eigen::Vector2d corner = projection.middle_px.cwiseQuotient(projection.scale) * points_.unit;
      const double depth = type_ ? depth_offset_ - turn.row(2).dot(points_.origin) : axis().offset;
      origin << corner - turn.topRows<2>() * points_.origin, depth;
    } else {
      origin = projection.from_eye(Eigen::Vector3d::Zero()) * points_.unit - turn * points_.origin;
    }
    std::array<double, 12> rows{};
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows.data()) << turn, origin;
    return rows;
  }

  /// Depth of the positions, for where that of the file does not serve; that of parallel rays begins before all points.
  ViewAxis axis() const {
    const Eigen::Vector3d forward = forward_sign_ * fit_->projection.axes.row(2).transpose();
    double offset = is_parallel_ ? 0 : points_.unit / fit_->projection.closeness;
    if (is_parallel_) {
      double least = HUGE_VAL;
      double most = -HUGE_VAL;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Eigen::Vector3d& p = points_.position[i];
        if ((fit_->projection.pixel_px(p) - points_.pixel_px[i]).norm() > 1 + errors_allowed * fit_->off_px) continue;
        least = std::min(least, forward.dot(p));
        most = std::max(most, forward.dot(p));
      }
      offset = (most - 2 * least + 1) * points_.unit;
    }
    return {{forward.x(), forward.y(), forward.z()}, offset - forward.dot(points_.origin)};
  }

  void add_depth(FoundCamera& out) const {
    if (!has_depth()) {
      out.axis = axis();
      return;
    }
    const std::string name = escaped(roles_[Role::depth][0][0]);
    if (!type_) {
      out.axis = axis();
      out.warnings.push_back(contradiction(name));
    }
    const bool is_terraced = !coarseness(picture_, roles_[Role::depth]).empty() && coarse_position_.empty();
    if (is_terraced && fit_->share >= 0.9) out.axis = axis();
    if (type_) check_frames(name, out);
    if (out.axis) return;
    if (told_ && *told_ != out.depth_type)
      out.warnings.push_back("--depth-type " + text_of(*told_) + ": the positions say that " + name + " is " +
                             text_of(out.depth_type) + ", which is used");
  }

  void check_frames(const std::string& name, FoundCamera& out) const {
    const FrameMatch match = match_frames(picture_, roles_, out, axis(), *fit_, points_);
    if (match.is_one_frame()) return;
    out.axis = axis();
    out.warnings.push_back(name + " contradicts the positions all around " + std::to_string(match.contradicted) +
                           " of " + std::to_string(match.seen) +
                           " pixels, as that of another frame does: depth comes from the positions");
  }

  /// Depths of parallel rays are those along the axis and a constant. In which of two directions the axis leads, depths
  /// alone tell: the world may be left-handed.
  void recognise_parallel_depth() {
    std::vector<double> along;
    for (const Eigen::Vector3d& p : points_.position)
      along.push_back(fit_->projection.axes.row(2).dot(p) * points_.unit);
    const DepthLine line = depth_line(along, points_.depth);
    std::vector<double> errors;
    for (std::size_t i = 0; i < along.size(); ++i)
      errors.push_back(std::abs(line.offset + line.factor * along[i] - static_cast<double>(points_.depth[i])));
    const double px_per_unit = std::sqrt(fit_->projection.scale.prod()) / points_.unit;
    const bool fits = median(std::move(errors)) * px_per_unit <= std::max(most_noise_px, errors_allowed * fit_->off_px);
    if (!fits || std::abs(std::abs(line.factor) - 1) > 0.01) return;
    const bool is_negative = median({points_.depth.begin(), points_.depth.end()}) < 0;
    type_ = {.kind = DepthKind::z, .is_negative = is_negative};
    forward_sign_ = (line.factor < 0) == is_negative ? 1 : -1;
    depth_offset_ = is_negative ? -line.offset : line.offset;
  }

  /// What is known of a depth that none of the types explains.
  std::string contradiction(const std::string& name) const {
    if (is_parallel_) return name + " contradicts the positions: depth comes from the positions";
    std::vector<double> expected;
    for (const Eigen::Vector3d& p : points_.position)
      expected.push_back((1 / fit_->projection.closeness + fit_->projection.axes.row(2).dot(p)) * points_.unit);
    const DepthLine line = depth_line(expected, points_.depth);
    const std::string end = ": depth comes from the positions";
    constexpr double small = 0.01;
    if (line.factor != 0 && line.off <= small) {
      const double typical = median(expected);
      const bool is_scaled = std::abs(line.offset) <= small * std::abs(line.factor) * typical;
      if (is_scaled && std::abs(line.factor - 1) <= small)
        return name + " is " + short_text(100 * line.off) + " % off that of the positions" + end;
      if (is_scaled) return name + " is " + short_text(line.factor) + " times the depth of the positions" + end;
      return name + " is normalised, 0 at " + short_text(-line.offset / line.factor) + " and 1 at " +
             short_text((1 - line.offset) / line.factor) + " scene units" + end;
    }
    return name + " contradicts the positions" + end;
  }

  void warn_of_aspect(FoundCamera& out) const {
    const double aspect = out.camera.scale_y / out.camera.scale_x;
    if (std::abs(aspect / picture_.pixel_aspect() - 1) > 2 * errors_allowed * fit_->scale_doubt + limit_)
      out.warnings.push_back("pixelAspectRatio is " + short_text(picture_.pixel_aspect()) + ", but by the positions " +
                             short_text(aspect) + ", which is used");
  }

  const Picture& picture_;
  const Roles& roles_;
  std::optional<DepthType> told_;
  SeenPoints points_;
  std::string coarse_position_;
  double limit_ = limit_fine;
  std::optional<Fit> free_;  ///< of the positions alone
  std::optional<Fit> fit_;   ///< the one that counts
  bool is_parallel_ = false;
  double forward_sign_ = 1;        ///< of the axis of parallel rays
  double depth_offset_ = 0;        ///< the depth of the points' origin, of parallel rays and depths that agree
  std::optional<DepthType> type_;  ///< of the depths, if they agree with the positions
};

}  // namespace

PositionCamera find_position_camera(const Picture& picture, const Roles& roles, const std::optional<DepthType>& told) {
  return Finding(picture, roles, told).run();
}

}  // namespace dermis::exr
