#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/compose.hpp"
#include "oracle/frame/entering_light.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/rotation.hpp"
#include "oracle/integral/disc_plane.hpp"
#include "oracle/integral/disc_reader.hpp"
#include "oracle/integral/disc_samples.hpp"
#include "oracle/integral/disc_texels.hpp"
#include "oracle/math/gauss_legendre.hpp"
#include "oracle/math/profile_table.hpp"
#include "oracle/math/weighted_sum.hpp"

namespace dermis::oracle {

namespace {

/// By default, a pixel has few samples up to a kernel radius of 2 px, and all from 3 px on.
constexpr int few_samples = 21;
constexpr int usual_samples = 55;
constexpr double few_radius_px = 2;

constexpr double steepest = 0.75;  ///< change of depth per change of place on the screen, of a disc
constexpr int most_levels = 9;
constexpr double share_within_reach = 1 - 1e-6;

/// A material, and its samples in each level of detail.
struct DiscMaterial {
  const Material* material;
  ProfileTable radial, cdf;
  std::array<std::vector<DiscSet>, 2> sets;  ///< few and all samples; there are no few if all pixels have as many
};

class DiscFilter {
 public:
  DiscFilter(const Surface& surface, const FrameImages& images, std::span<const Material> materials,
             const Options& options, const BoundedPicture& light)
      : surface_(surface),
        images_(images),
        options_(options),
        light_(light),
        texels_(surface, light, options.disc.prefiltered ? most_levels : 1),
        edge_rule_(gauss_legendre(8)) {
    const int samples = options.disc.samples;
    for (const Material& material : materials) {
      discs_.push_back({&material,
                        ProfileTable(material.radial),
                        ProfileTable(material.cdf),
                        {make_disc_sets(material, samples > 0 ? 0 : few_samples),
                         make_disc_sets(material, samples > 0 ? samples : usual_samples)}});
    }
  }

  /// Returns the light of a pixel after scattering.
  BoundedRgb at(int x, int y) const {
    const SurfacePixel& pixel = surface_.at(x, y);
    const DiscMaterial& disc = discs_[pixel.material];
    const Bounded width = widest(pixel, *disc.material);
    const BoundedRgb own = own_share(x, y, disc);
    BoundedRgb result{};
    bool is_first = true;
    for (const DiscPlane& plane : planes_at(x, y)) {
      const BoundedRgb light = by_shares({x, y, pixel, disc, width, plane, own});
      for (int c = 0; c < 3; ++c) result[c] = is_first ? light[c] : including(result[c], light[c]);
      is_first = false;
    }
    return result;
  }

 private:
  /// A pixel that gathers light.
  struct Target {
    int x, y;
    const SurfacePixel& pixel;
    const DiscMaterial& disc;
    Bounded width;    ///< of its profile over that of the material
    DiscPlane plane;  ///< not turned
    BoundedRgb own;   ///< R integrated over its own patch
  };

  static Bounded widest(const SurfacePixel& pixel, const Material& material) {
    Bounded width;
    for (int c = 0; c < 3; ++c) {
      width = larger(width, pixel.width_factor[c] * exact(static_cast<double>(material.taps.relative_width[c])));
    }
    return width;
  }

  /// Returns the share of the result with all samples; the rest comes from few.
  static Bounded share_of_all(const Target& target) {
    const Bounded px_per_mm = larger(target.pixel.px_per_mm[horizontal], target.pixel.px_per_mm[vertical]);
    const Bounded radius_px = as_float(target.disc.material->taps.radius_mm) * target.width * px_per_mm;
    return clamped(rounded(radius_px, division_roundings) - exact(few_radius_px), 0, 1);
  }

  /// A direction of depth along the screen: it changes by `change` where the ray goes `forward`.
  struct Slope {
    std::array<Bounded, 2> change;
    Bounded forward;
  };

  /// Returns the plane that a device takes, or both where float32 cannot tell whether the normal faces the camera.
  std::vector<DiscPlane> planes_at(int x, int y) const {
    const View& view = surface_.view();
    const Bounded z = surface_.at(x, y).position_mm[2];
    const std::array<Bounded, 2> size{view.size_mm(horizontal, z), view.size_mm(vertical, z)};
    if (!options_.disc.tangent_plane) {
      return {DiscPlane::of({size[horizontal], exact(0), exact(0)}, {exact(0), size[vertical], exact(0)})};
    }
    std::vector<DiscPlane> planes;
    const std::optional<Slope> by_normal = slope_by_normal(x, y);
    if (by_normal && by_normal->forward.high() > 0) planes.push_back(tangent_plane(x, y, *by_normal, size));
    if (!by_normal || by_normal->forward.low() <= 0) {
      Slope by_depth{{}, exact(1)};
      for (const Axis axis : {horizontal, vertical}) {
        by_depth.change[axis] = surface_.depth_slope(x, y, axis) / size[axis];
      }
      planes.push_back(tangent_plane(x, y, by_depth, size));
    }
    return planes;
  }

  /// Along a plane n.P does not change. Lengths of normals do not matter, so that the largest part is made 1.
  std::optional<Slope> slope_by_normal(int x, int y) const {
    if (!is_there(images_.normal)) return std::nullopt;
    const auto n = [&](int i) { return exact(images_.normal(x, y, i)); };
    const auto ray = [&](Axis axis) { return surface_.view().ray(axis, (axis == horizontal ? x : y) + 0.5); };
    const Bounded forward = exact(0) - rounded(n(0) * ray(horizontal) + n(1) * ray(vertical) + n(2));
    const Bounded largest = larger(larger(absolute(n(0)), absolute(n(1))), absolute(forward));
    if (!std::isfinite(n(0).value) || !std::isfinite(n(1).value) || !std::isfinite(forward.value)) return std::nullopt;
    if (largest.value == 0) return std::nullopt;
    return Slope{{n(0) / largest, n(1) / largest}, forward / largest};
  }

  /// Depth changes by `steepest` at most.
  DiscPlane tangent_plane(int x, int y, const Slope& slope, const std::array<Bounded, 2>& size) const {
    const Bounded along = square_root(
        rounded(slope.change[horizontal] * slope.change[horizontal] + slope.change[vertical] * slope.change[vertical]));
    const Bounded limit = exact(steepest) / larger(along, exact(steepest) * slope.forward);
    std::array<Tangent, 2> tangents;
    for (const Axis axis : {horizontal, vertical}) {
      tangents[axis] = surface_.tangent(x, y, axis, limit * slope.change[axis] * size[axis]);
    }
    return DiscPlane::of(tangents[horizontal], tangents[vertical]);
  }

  /// Gathers few and all samples.
  BoundedRgb by_shares(const Target& target) const {
    const DiscMaterial& disc = target.disc;
    const Bounded all = disc.sets[0].empty() ? exact(1) : share_of_all(target);
    BoundedRgb result{};
    for (int which = 0; which < 2; ++which) {
      const Bounded part = which == 0 ? exact(1) - all : all;
      if (is_exactly(part, 0)) continue;
      const BoundedRgb light = by_sets(target, disc.sets[which]);
      for (int c = 0; c < 3; ++c) result[c] = result[c] + part * light[c];
    }
    return result;
  }

  /// Gathers from the set that the pixel's inner disc allows; the bound admits every set that a device may take.
  BoundedRgb by_sets(const Target& target, const std::vector<DiscSet>& sets) const {
    const Bounded& inner_mm = target.plane.inner_mm;
    BoundedRgb result{};
    bool is_first = true;
    for (std::size_t start = sets.size(); start-- > 0;) {
      const Bounded inner = target.width * as_float(sets[start].inner_mm);
      if (start > 0 && inner_mm.high() < inner.low()) continue;
      const BoundedRgb light = mean_over_seeds(target, sets[start]);
      for (int c = 0; c < 3; ++c) result[c] = is_first ? light[c] : including(result[c], light[c]);
      is_first = false;
      if (start == 0 || inner_mm.low() >= inner.high()) break;
    }
    return result;
  }

  BoundedRgb mean_over_seeds(const Target& target, const DiscSet& set) const {
    const int seeds = options_.disc.accumulate;
    std::array<std::vector<Bounded>, 3> results;
    for (int i = 0; i < seeds; ++i) {
      const int turn = turn_of(target.x, target.y, options_.seed + static_cast<std::uint32_t>(i));
      const BoundedRgb light = gathered(target, set, target.plane.turned(2 * std::numbers::pi * turn / 256));
      for (int c = 0; c < 3; ++c) results[c].push_back(light[c]);
    }
    BoundedRgb mean;
    for (int c = 0; c < 3; ++c) mean[c] = rounded(sum_of(results[c]) * exact(1.0 / seeds), division_roundings);
    return mean;
  }

  BoundedRgb gathered(const Target& target, const DiscSet& set, const DiscPlane& plane) const {
    const auto [x, y] = std::pair{target.x, target.y};
    const DiscReader reader(surface_, texels_, x, y);
    std::array<WeightedSum, 3> sums;
    for (int c = 0; c < 3; ++c) sums[c].add(target.own[c], light_.at(x, y, c));
    for (const DiscSample& sample : set.samples) {
      const Bounded a = target.width * as_float(sample.x_mm);
      const Bounded b = target.width * as_float(sample.y_mm);
      const SamplePlace place{plane.x_x * a + plane.x_y * b, plane.y_x * a + plane.y_y * b,
                              target.width * as_float(sample.spacing_mm) * plane.px_per_mm};
      add_sample(sums, target, reader, place);
    }
    BoundedRgb means;
    for (int c = 0; c < 3; ++c) means[c] = sums[c].mean(light_.at(x, y, c));
    return means;
  }

  /// Adds one sample; the bound admits everything that a device may read there.
  static void add_sample(std::array<WeightedSum, 3>& sums, const Target& target, const DiscReader& reader,
                         const SamplePlace& place) {
    const std::vector<std::optional<Reading>> outcomes = reader.read(place);
    BoundedRgb weight{};
    BoundedRgb light{};
    bool has_light = false;
    for (const std::optional<Reading>& reading : outcomes) {
      const bool is_first = &reading == &outcomes.front();
      for (int c = 0; c < 3; ++c) {
        Bounded own_weight;
        if (reading) {
          const Bounded r_squared = reader.squared_distance(place, reading->rise_mm);
          own_weight = density(target, c, r_squared) * place.spacing * place.spacing * reading->area_mm2;
          light[c] = has_light ? including(light[c], reading->light[c]) : reading->light[c];
        }
        weight[c] = is_first ? own_weight : including(weight[c], own_weight);
      }
      has_light = has_light || reading;
    }
    if (!has_light) return;
    // A device multiplies light by the area first and by the weight then, in no more roundings than these.
    for (int c = 0; c < 3; ++c) sums[c].add(rounded(weight[c], 4), rounded(light[c], 8));
  }

  /// Returns R(r / k) / k^2. Beyond the reach a device may take 0 for it.
  static Bounded density(const Target& target, int c, Bounded r_squared) {
    const Bounded k = target.pixel.width_factor[c];
    const Bounded reciprocal = exact(1) / k;
    Bounded value = target.disc.radial.at(c, r_squared, k);
    bool is_beyond = true;
    for (int i = 0; i < 3; ++i) {
      const double share = target.disc.material->cdf(i, std::sqrt(r_squared.high()) / k.low());
      is_beyond = is_beyond && share > share_within_reach - 1e-7;
    }
    if (is_beyond) value.error = std::max(value.error, value.value);
    return value * reciprocal * reciprocal;
  }

  /// Integrates R over the patch of the pixel, as surface_integral does.
  BoundedRgb own_share(int x, int y, const DiscMaterial& disc) const {
    const SurfacePixel& pixel = surface_.at(x, y);
    std::array<Tangent, 2> tangents;
    for (const Axis axis : {horizontal, vertical}) {
      tangents[axis] = surface_.tangent(x, y, axis, surface_.depth_slope(x, y, axis));
    }
    const Bounded area = exact(pixel.covered) * exact(pixel.covered) * patch_area(tangents[0], tangents[1]);
    std::array<std::vector<Bounded>, 3> parts;
    for (const Axis axis : {horizontal, vertical}) {
      for (const QuadraturePoint& t : edge_rule_) {
        Bounded r_squared;
        for (int i = 0; i < 3; ++i) {
          const Bounded edge = exact(0.5) * tangents[axis][i] + as_float(t.position) * tangents[1 - axis][i];
          r_squared = r_squared + edge * edge;
        }
        r_squared = rounded(r_squared);
        const Bounded angle = as_float(t.weight) * exact(0.5) * area / r_squared;
        for (int c = 0; c < 3; ++c) {
          const Bounded share = disc.cdf.at(c, r_squared, pixel.width_factor[c]);
          parts[c].push_back(angle * as_float(std::numbers::inv_pi) * share);
        }
      }
    }
    return {sum_of(parts[0]), sum_of(parts[1]), sum_of(parts[2])};
  }

  const Surface& surface_;
  const FrameImages& images_;
  const Options& options_;
  const BoundedPicture& light_;
  DiscTexels texels_;
  std::vector<QuadraturePoint> edge_rule_;
  std::vector<DiscMaterial> discs_;
};

}  // namespace

Reference disc(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Light light(images, options);
  const Surface surface(frame, images, materials, light, false);
  const BoundedPicture before = light.filtered();
  const BoundedPicture entering = entering_light(surface, images, materials, options, before);
  const DiscFilter filter(surface, images, materials, options, entering);
  BoundedPicture scattered = before;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfacePixel& pixel = surface.at(x, y);
      if (!pixel.takes_light() && !pixel.takes_light_unsure()) continue;
      const BoundedRgb after = filter.at(x, y);
      for (int c = 0; c < 3; ++c) {
        const Bounded taken = pixel.takes_light() ? after[c] : before.at(x, y, c);
        const Bounded left = pixel.takes_light() ? before.at(x, y, c) : after[c];
        scattered.set(x, y, c, pixel.takes_light_unsure() ? including(taken, left) : taken);
      }
    }
  }
  return compose(surface, light, scattered);
}

}  // namespace dermis::oracle
