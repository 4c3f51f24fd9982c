#include "oracle/integral/disc_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oracle/math/weighted_sum.hpp"

namespace dermis::oracle {

namespace {

/// Returns the mean by shares that are not negative. Whatever the shares are, it lies among the values.
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

/// Returns how far the middle of a texel lies from the centre of a pixel along one axis, pixels; `steps` counts texels
/// from that which contains the pixel.
double middle_of_texel(int pixel, int level, int steps) {
  return ((pixel >> level) + steps + 0.5) * (1 << level) - (pixel + 0.5);
}

/// Returns `a` where a device cannot have less than `least`.
Bounded no_less(Bounded a, double least) {
  if (!(a.low() < least && least < a.high())) return a;
  return {0.5 * (least + a.high()), 0.5 * (a.high() - least)};
}

}  // namespace

/// Two by two texels of a level, and the share of the right column and of the lower row.
struct DiscReader::Square {
  int level;
  int column, row;  ///< of the upper left texel, counted from that which contains the pixel
  Bounded right, below;
};

/// A try to read texels of one size. It fails if a share falls on a block that is not wholly of the material.
struct DiscReader::Attempt {
  bool may_succeed = true;
  bool may_fail = false;
  std::optional<Reading> reading;
};

std::vector<std::optional<Reading>> DiscReader::read(const SamplePlace& place) const {
  std::vector<std::optional<Reading>> outcomes;
  const int coarsest = level_of(place.spacing.high());
  for (int first = level_of(place.spacing.low()); first <= coarsest; ++first) read_from(first, place, outcomes);
  return outcomes;
}

// A place on the screen is a ray from the camera, p = a + h b, with a across the view, h the rise and b = (., ., 1). No
// point of it is nearer than |a x b| / |b|, which is |a| / |b| at least. That matters where the rise is hardly known.
Bounded DiscReader::squared_distance(const SamplePlace& place, Bounded rise) const {
  const View& view = surface_.view();
  const Bounded own_z = pixel_.position_mm[2];
  const Bounded z = own_z + rise;
  Bounded sum = rise * rise;
  double across = 0;
  double along = 1;
  for (const Axis axis : {horizontal, vertical}) {
    const Bounded d = axis == horizontal ? place.dx : place.dy;
    const Bounded ray = view.ray(axis, (axis == horizontal ? x_ : y_) + 0.5);
    const Bounded part = ray * rise + d * view.size_mm(axis, z);
    sum = sum + part * part;
    const double least = std::max(absolute(d).low(), 0.0) * view.size_mm(axis, own_z).low();
    across += least * least;
    const double tilt = std::abs(ray.value) + std::abs(d.value) * view.growth_mm(axis, exact(1)).value;
    along += tilt * tilt;
  }
  return no_less(rounded(sum), across / along);
}

int DiscReader::level_of(double spacing) const {
  return std::clamp(spacing > 0 ? std::ilogb(spacing) : 0, 0, texels_.levels() - 1);
}

/// Adds the outcomes of a sample that tries texels of a level first, and finer ones where these fail.
void DiscReader::read_from(int level, const SamplePlace& place, std::vector<std::optional<Reading>>& outcomes) const {
  const double size = 1 << level;
  const Bounded u = (place.dx - exact(middle_of_texel(x_, level, 0))) * exact(1 / size);
  const Bounded v = (place.dy - exact(middle_of_texel(y_, level, 0))) * exact(1 / size);
  const Bounded sharpness = exact(size) / place.spacing;
  const auto share = [&](Bounded at, double texel) {
    return clamped((at - exact(texel) - exact(0.5)) * sharpness + exact(0.5), 0, 1);
  };
  const auto whole = [](double at) { return static_cast<int>(std::floor(at)); };
  bool may_fail = false;
  for (int column = whole(u.low()); column <= whole(u.high()); ++column) {
    for (int row = whole(v.low()); row <= whole(v.high()); ++row) {
      const Square square{level, column, row, share(u, column), share(v, row)};
      const Attempt attempt = read_square(square, place);
      if (attempt.may_succeed) outcomes.push_back(attempt.reading);
      may_fail = may_fail || attempt.may_fail;
    }
  }
  if (may_fail) read_from(level - 1, place, outcomes);
}

DiscReader::Attempt DiscReader::read_square(const Square& square, const SamplePlace& place) const {
  const auto& [level, column, row, right, below] = square;
  Attempt attempt;
  std::vector<Bounded> shares;
  std::vector<Bounded> areas;
  std::vector<Bounded> rises;
  std::array<std::vector<Bounded>, 3> lights;
  for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
    const Bounded share = (i == 0 ? exact(1) - right : right) * (j == 0 ? exact(1) - below : below);
    if (is_exactly(share, 0)) continue;
    const int along_x = column + i;
    const int along_y = row + j;
    const Texel* texel = texels_.at(level, (x_ >> level) + along_x, (y_ >> level) + along_y);
    const bool holds_pixel = along_x == 0 && along_y == 0;
    const bool counts = texel != nullptr && !holds_pixel && texel->material == pixel_.material;
    if (level > 0 && (!counts || texel->material_unsure)) {
      attempt.may_fail = true;
      if (!counts && share.low() > 0) attempt.may_succeed = false;
    }
    if (!counts) continue;
    shares.push_back(share);
    areas.push_back(share * texel->area_mm2);
    const Bounded from_middle_x = place.dx - exact(middle_of_texel(x_, level, along_x));
    const Bounded from_middle_y = place.dy - exact(middle_of_texel(y_, level, along_y));
    rises.push_back((texel->z_mm - pixel_.position_mm[2]) + from_middle_x * texel->slope[horizontal] +
                    from_middle_y * texel->slope[vertical]);
    for (int c = 0; c < 3; ++c) lights[c].push_back(texel->light[c]);
  }
  if (shares.empty()) return attempt;
  Reading reading;
  for (int c = 0; c < 3; ++c) reading.light[c] = mean_of(areas, lights[c]);
  reading.area_mm2 = sum_of(areas);
  reading.rise_mm = mean_of(shares, rises);
  attempt.reading = reading;
  return attempt;
}

}  // namespace dermis::oracle
