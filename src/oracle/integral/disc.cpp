#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/compose.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/rotation.hpp"
#include "oracle/integral/disc_samples.hpp"
#include "oracle/integral/disc_texels.hpp"
#include "oracle/math/gauss_legendre.hpp"
#include "oracle/math/profile_table.hpp"
#include "oracle/math/weighted_sum.hpp"

namespace dermis::oracle {

namespace {

using BoundedRgb = std::array<Bounded, 3>;

/// Levels of detail: few samples up to a kernel radius of 2 px, all from 3 px on.
constexpr int few_samples = 21;
constexpr int usual_samples = 55;
constexpr double few_radius_px = 2;

constexpr double steepest = 0.75;  ///< change of depth per change of place on the screen, of a disc
constexpr int most_levels = 9;
constexpr double share_within_reach = 1 - 1e-6;

double count_of(const std::vector<Bounded>& values) { return static_cast<double>(values.size()); }

Bounded sum_of(const std::vector<Bounded>& values) {
  Bounded sum;
  double magnitudes = 0;
  for (const Bounded value : values) {
    sum = {sum.value + value.value, sum.error + value.error};
    magnitudes += value.magnitude();
  }
  return {sum.value, sum.error + count_of(values) * unit_roundoff * magnitudes};
}

/// The mean by shares that are not negative: whatever they are, it lies among the values.
Bounded mean_of(const std::vector<Bounded>& shares, const std::vector<Bounded>& values) {
  WeightedSum sum;
  double low = values.front().low();
  double high = values.front().high();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    sum.add(shares[i], values[i]);
    low = std::min(low, values[i].low());
    high = std::max(high, values[i].high());
  }
  const Bounded mean = sum.mean(values.front());
  const Bounded among = rounded({mean.value, std::max(high - mean.value, mean.value - low)}, 12);
  return mean.error < among.error ? mean : among;
}

/// A linear map from mm along a plane, on axes at right angles, to pixels.
struct DiscPlane {
  Bounded x_x, x_y, y_x, y_y;
  Bounded px_per_mm;
  Bounded inner_mm;  ///< the radius of the disc that a pixel contains

  /// Of the plane in which a pixel spans these.
  static DiscPlane of(const Tangent& x, const Tangent& y) {
    const auto dot = [](const Tangent& a, const Tangent& b) {
      return rounded(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    };
    const Bounded length_x = square_root(dot(x, x));
    const Bounded area = patch_area(x, y);
    const Bounded along = dot(x, y) / length_x;
    return {exact(1) / length_x,
            exact(-1) * along / area,
            exact(0),
            exact(1) / (area / length_x),
            exact(1) / square_root(area),
            exact(0.5) * area / larger(length_x, square_root(dot(y, y)))};
  }

  DiscPlane turned(double angle) const {
    const Bounded cosine = as_float(std::cos(angle));
    const Bounded sine = as_float(std::sin(angle));
    DiscPlane plane = *this;
    plane.x_x = x_x * cosine + x_y * sine;
    plane.x_y = x_y * cosine - x_x * sine;
    plane.y_x = y_x * cosine + y_y * sine;
    plane.y_y = y_y * cosine - y_x * sine;
    return plane;
  }
};

/// What a sample finds: light and the area of surface per pixel by its shares on texels, and how much deeper it lies.
struct Reading {
  BoundedRgb light;
  Bounded area_mm2;
  Bounded rise_mm;
};

/// One try to read blocks of one size.
struct Attempt {
  bool may_succeed = true;
  bool may_fail = false;
  std::optional<Reading> reading;  ///< none if no texel has a share
};

/// Light of the samples of one pixel.
class Gatherer {
 public:
  Gatherer(const Surface& surface, const DiscTexels& texels, int x, int y)
      : surface_(surface), texels_(texels), x_(x), y_(y), pixel_(surface.at(x, y)) {}

  /// All outcomes of a sample, (dx, dy) pixels away.
  std::vector<std::optional<Reading>> read(Bounded spacing_px, Bounded dx, Bounded dy) const {
    std::vector<std::optional<Reading>> outcomes;
    const int coarsest = level_of(spacing_px.high());
    for (int first = level_of(spacing_px.low()); first <= coarsest; ++first) {
      read_from(first, spacing_px, dx, dy, outcomes);
    }
    return outcomes;
  }

  Bounded squared_distance(Bounded dx, Bounded dy, Bounded rise) const {
    const Bounded z = pixel_.position_mm[2] + rise;
    Bounded sum = rise * rise;
    for (const Axis axis : {horizontal, vertical}) {
      const Bounded ray = surface_.view().ray(axis, (axis == horizontal ? x_ : y_) + 0.5);
      const Bounded part = ray * rise + (axis == horizontal ? dx : dy) * surface_.view().size_mm(axis, z);
      sum = sum + part * part;
    }
    return rounded(sum);
  }

 private:
  int level_of(double spacing_px) const {
    return std::clamp(spacing_px > 0 ? std::ilogb(spacing_px) : 0, 0, texels_.levels() - 1);
  }

  void read_from(int level, Bounded spacing_px, Bounded dx, Bounded dy,
                 std::vector<std::optional<Reading>>& outcomes) const {
    const double size = 1 << level;
    const auto middle = [&](int pixel) { return ((pixel >> level) + 0.5) * size - (pixel + 0.5); };
    const Bounded u = (dx - exact(middle(x_))) * exact(1 / size);
    const Bounded v = (dy - exact(middle(y_))) * exact(1 / size);
    const Bounded sharpness = exact(size) / spacing_px;
    bool may_fail = false;
    for (double column = std::floor(u.low()); column <= std::floor(u.high()); ++column) {
      for (double row = std::floor(v.low()); row <= std::floor(v.high()); ++row) {
        const Bounded right = held_within((u - exact(column) - exact(0.5)) * sharpness + exact(0.5), 0, 1);
        const Bounded below = held_within((v - exact(row) - exact(0.5)) * sharpness + exact(0.5), 0, 1);
        const Attempt attempt =
            read_blocks(level, static_cast<int>(column), static_cast<int>(row), right, below, dx, dy);
        if (attempt.may_succeed) outcomes.push_back(attempt.reading);
        may_fail = may_fail || attempt.may_fail;
      }
    }
    if (may_fail) read_from(level - 1, spacing_px, dx, dy, outcomes);
  }

  Attempt read_blocks(int level, int column, int row, Bounded right, Bounded below, Bounded dx, Bounded dy) const {
    Attempt attempt;
    std::vector<Bounded> shares, areas, rises;
    std::array<std::vector<Bounded>, 3> lights;
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        const Bounded share = (i == 0 ? exact(1) - right : right) * (j == 0 ? exact(1) - below : below);
        if (share.value == 0 && share.error == 0) continue;
        const int across = column + i;
        const int down = row + j;
        const Texel* texel = texels_.at(level, (x_ >> level) + across, (y_ >> level) + down);
        const bool is_mine = texel != nullptr && (across != 0 || down != 0) && texel->material == pixel_.material;
        if (level > 0 && (!is_mine || texel->material_unsure)) {
          attempt.may_fail = true;
          if (!is_mine && share.low() > 0) attempt.may_succeed = false;
        }
        if (!is_mine) continue;
        shares.push_back(share);
        areas.push_back(share * texel->area_mm2);
        const double size = 1 << level;
        const auto from = [&](int pixel, int steps) {
          return exact(((pixel >> level) + steps + 0.5) * size - (pixel + 0.5));
        };
        rises.push_back((texel->z_mm - pixel_.position_mm[2]) + (dx - from(x_, across)) * texel->slope[horizontal] +
                        (dy - from(y_, down)) * texel->slope[vertical]);
        for (int c = 0; c < 3; ++c) lights[c].push_back(texel->light[c]);
      }
    }
    if (shares.empty()) return attempt;
    Reading reading;
    for (int c = 0; c < 3; ++c) reading.light[c] = mean_of(areas, lights[c]);
    reading.area_mm2 = sum_of(areas);
    reading.rise_mm = mean_of(shares, rises);
    attempt.reading = reading;
    return attempt;
  }

  const Surface& surface_;
  const DiscTexels& texels_;
  int x_, y_;
  const SurfacePixel& pixel_;
};

/// A material, and its samples in each level of detail.
struct DiscMaterial {
  const Material* material;
  ProfileTable radial, cdf;
  std::array<std::vector<DiscSet>, 2> sets;  ///< few and all; few are none if all pixels have as many
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

  BoundedRgb at(int x, int y) const {
    const SurfacePixel& pixel = surface_.at(x, y);
    const DiscMaterial& disc = discs_[pixel.material];
    const Bounded width = widest(pixel, *disc.material);
    const Bounded all = disc.sets[0].empty() ? exact(1) : share_of_all(pixel, *disc.material, width);
    BoundedRgb result{};
    for (int which = 0; which < 2; ++which) {
      const Bounded part = which == 0 ? exact(1) - all : all;
      if (part.value == 0 && part.error == 0) continue;
      const BoundedRgb its = by_sets(x, y, disc, disc.sets[which], width);
      for (int c = 0; c < 3; ++c) result[c] = result[c] + part * its[c];
    }
    return result;
  }

 private:
  static Bounded widest(const SurfacePixel& pixel, const Material& material) {
    Bounded width;
    for (int c = 0; c < 3; ++c) {
      width = larger(width, pixel.width_factor[c] * exact(static_cast<double>(material.taps.relative_width[c])));
    }
    return width;
  }

  static Bounded share_of_all(const SurfacePixel& pixel, const Material& material, Bounded width) {
    const Bounded px_per_mm = larger(pixel.px_per_mm[horizontal], pixel.px_per_mm[vertical]);
    const Bounded radius_px = as_float(material.taps.radius_mm) * width * px_per_mm;
    return held_within(rounded(radius_px, division_roundings) - exact(few_radius_px), 0, 1);
  }

  DiscPlane plane_at(int x, int y) const {
    const Bounded z = surface_.at(x, y).position_mm[2];
    const std::array<Bounded, 2> size{surface_.view().size_mm(horizontal, z), surface_.view().size_mm(vertical, z)};
    if (!options_.disc.tangent_plane) {
      return DiscPlane::of({size[horizontal], exact(0), exact(0)}, {exact(0), size[vertical], exact(0)});
    }
    std::array<Bounded, 2> steep;
    for (const Axis axis : {horizontal, vertical}) steep[axis] = surface_.depth_slope(x, y, axis) / size[axis];
    if (is_there(images_.normal)) {
      const auto n = [&](int i) { return exact(images_.normal(x, y, i)); };
      const auto ray = [&](Axis axis) { return surface_.view().ray(axis, (axis == horizontal ? x : y) + 0.5); };
      const Bounded facing = exact(0) - rounded(n(0) * ray(horizontal) + n(1) * ray(vertical) + n(2));
      const std::array<Bounded, 2> its{n(0) / facing, n(1) / facing};
      if (facing.value > 0 && std::isfinite(its[0].value) && std::isfinite(its[1].value)) steep = its;
    }
    const Bounded length = square_root(rounded(steep[0] * steep[0] + steep[1] * steep[1]));
    std::array<Tangent, 2> tangents;
    for (const Axis axis : {horizontal, vertical}) {
      // min(1, steepest / length) has no jump.
      Bounded slope = length.value > steepest ? steep[axis] * (exact(steepest) / length) : steep[axis];
      if (length.low() <= steepest && length.high() > steepest) slope = rounded(slope, division_roundings + 8);
      tangents[axis] = surface_.tangent(x, y, axis, slope * size[axis]);
    }
    return DiscPlane::of(tangents[horizontal], tangents[vertical]);
  }

  /// The sets that the samples of a pixel may be of.
  BoundedRgb by_sets(int x, int y, const DiscMaterial& disc, const std::vector<DiscSet>& sets, Bounded width) const {
    const DiscPlane plane = plane_at(x, y);
    BoundedRgb result{};
    bool is_first = true;
    for (std::size_t start = sets.size(); start-- > 0;) {
      const Bounded inner = width * as_float(sets[start].inner_mm);
      if (start > 0 && plane.inner_mm.high() < inner.low()) continue;
      const BoundedRgb its = mean_over_seeds(x, y, disc, sets[start], width, plane);
      for (int c = 0; c < 3; ++c) result[c] = is_first ? its[c] : including(result[c], its[c]);
      is_first = false;
      if (start == 0 || plane.inner_mm.low() >= inner.high()) break;
    }
    return result;
  }

  BoundedRgb mean_over_seeds(int x, int y, const DiscMaterial& disc, const DiscSet& set, Bounded width,
                             const DiscPlane& plane) const {
    const BoundedRgb own = own_share(x, y, disc);
    const int seeds = options_.disc.accumulate;
    std::array<std::vector<Bounded>, 3> results;
    for (int i = 0; i < seeds; ++i) {
      const int turn = turn_of(x, y, options_.seed + static_cast<std::uint32_t>(i));
      const DiscPlane turned = plane.turned(2 * std::numbers::pi * turn / 256);
      const BoundedRgb its = gathered(x, y, disc, set, width, turned, own);
      for (int c = 0; c < 3; ++c) results[c].push_back(its[c]);
    }
    BoundedRgb mean;
    for (int c = 0; c < 3; ++c) mean[c] = rounded(sum_of(results[c]) * exact(1.0 / seeds), division_roundings);
    return mean;
  }

  BoundedRgb gathered(int x, int y, const DiscMaterial& disc, const DiscSet& set, Bounded width, const DiscPlane& plane,
                      const BoundedRgb& own) const {
    const Gatherer gatherer(surface_, texels_, x, y);
    std::array<WeightedSum, 3> sums;
    for (int c = 0; c < 3; ++c) sums[c].add(own[c], light_.at(x, y, c));
    for (const DiscSample& sample : set.samples) {
      const Bounded a = width * as_float(sample.x_mm);
      const Bounded b = width * as_float(sample.y_mm);
      const Bounded dx = plane.x_x * a + plane.x_y * b;
      const Bounded dy = plane.y_x * a + plane.y_y * b;
      const Bounded spacing_px = width * as_float(sample.spacing_mm) * plane.px_per_mm;
      add_sample(sums, gatherer, gatherer.read(spacing_px, dx, dy), disc, surface_.at(x, y), spacing_px, dx, dy);
    }
    BoundedRgb means;
    for (int c = 0; c < 3; ++c) means[c] = sums[c].mean(light_.at(x, y, c));
    return means;
  }

  /// One sample, which may find any of these.
  void add_sample(std::array<WeightedSum, 3>& sums, const Gatherer& gatherer,
                  const std::vector<std::optional<Reading>>& outcomes, const DiscMaterial& disc,
                  const SurfacePixel& pixel, Bounded spacing_px, Bounded dx, Bounded dy) const {
    BoundedRgb weight{};
    BoundedRgb light{};
    bool has_light = false;
    for (const std::optional<Reading>& reading : outcomes) {
      const bool is_first = &reading == &outcomes.front();
      for (int c = 0; c < 3; ++c) {
        Bounded its;
        if (reading) {
          const Bounded r_squared = gatherer.squared_distance(dx, dy, reading->rise_mm);
          its = density(disc, pixel, c, r_squared) * spacing_px * spacing_px * reading->area_mm2;
          light[c] = has_light ? including(light[c], reading->light[c]) : reading->light[c];
        }
        weight[c] = is_first ? its : including(weight[c], its);
      }
      has_light = has_light || reading;
    }
    if (!has_light) return;
    // Light is multiplied by area first, and by the weight then: not more than so many roundings.
    for (int c = 0; c < 3; ++c) sums[c].add(rounded(weight[c], 4), rounded(light[c], 8));
  }

  /// R(r / k) / k^2.
  static Bounded density(const DiscMaterial& disc, const SurfacePixel& pixel, int c, Bounded r_squared) {
    const Bounded k = pixel.width_factor[c];
    const Bounded reciprocal = exact(1) / k;
    Bounded value = disc.radial.at(c, r_squared, k);
    bool is_beyond = true;
    for (int i = 0; i < 3; ++i) {
      is_beyond = is_beyond && disc.material->cdf(i, std::sqrt(r_squared.high()) / k.low()) > share_within_reach - 1e-7;
    }
    if (is_beyond) value.error = std::max(value.error, value.value);
    return value * reciprocal * reciprocal;
  }

  /// R integrated over the patch of the pixel, as in surface_integral.
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
  const Surface surface(frame, images, materials, false);
  const Light light(images, options);
  const BoundedPicture x = light.filtered();
  const DiscFilter filter(surface, images, materials, options, x);
  BoundedPicture scattered = x;
  for (int j = 0; j < surface.height(); ++j) {
    for (int i = 0; i < surface.width(); ++i) {
      const SurfacePixel& pixel = surface.at(i, j);
      if (!pixel.takes_light() && !pixel.takes_light_unsure()) continue;
      const BoundedRgb values = filter.at(i, j);
      for (int c = 0; c < 3; ++c) {
        const Bounded taken = pixel.takes_light() ? values[c] : x.at(i, j, c);
        const Bounded left = pixel.takes_light() ? x.at(i, j, c) : values[c];
        scattered.set(i, j, c, pixel.takes_light_unsure() ? including(taken, left) : taken);
      }
    }
  }
  return recompose(surface, light, scattered);
}

}  // namespace dermis::oracle
