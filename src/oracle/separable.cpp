#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame_images.hpp"
#include "oracle/light.hpp"
#include "oracle/radial_table.hpp"
#include "oracle/recompose.hpp"
#include "oracle/rotation.hpp"
#include "oracle/surface.hpp"
#include "oracle/weighted_mean.hpp"

namespace dermis::oracle {

namespace {

constexpr int span_px = 16;
constexpr double host_rounding = 1e-6;  // relative: a device may compute its settings in float32

/// A whole number that a device may round to another one.
struct Choice {
  int nominal;
  int lowest;
  int highest;
};

/// The rung of a kernel radius: -1 below half a pixel, then 16 equal steps in each octave.
int rung_of(double radius_px, const Taps& taps) {
  const double ratio = radius_px / static_cast<double>(Taps::min_radius_px);
  if (!(ratio >= 1)) return -1;
  int exponent = 0;
  const double fraction = 2 * std::frexp(ratio, &exponent) - 1;
  constexpr int steps = 1 << Taps::log2_rungs_per_octave;
  const double rung = steps * (exponent - 1.0) + std::floor(steps * fraction);
  return static_cast<int>(std::min(rung, static_cast<double>(taps.rungs.size()) - 1));
}

Choice rung_choice(Bounded span_footprint, const Taps& taps) {
  const Bounded radius_px = span_footprint * as_float(taps.radius_mm);
  return {rung_of(radius_px.value, taps), rung_of(radius_px.low(), taps), rung_of(radius_px.high(), taps)};
}

/// How many of a rung's pairs are rotated, the innermost first.
Choice rotated_choice(const Rung& rung, const Taps& taps, double jitter) {
  const double reach_px = jitter * static_cast<double>(rung.footprint) * taps.radius_mm;
  const auto within = [&](double reach) {
    return static_cast<int>(std::count_if(rung.pairs.begin(), rung.pairs.end(),
                                          [&](const TapPair& pair) { return pair.offset_px <= reach; }));
  };
  return {within(reach_px), within(reach_px * (1 - host_rounding)), within(reach_px * (1 + host_rounding))};
}

/// One pass over a frame, along one axis.
class Pass {
 public:
  Pass(Axis axis, const Surface& surface, std::span<const Material> materials, const Frame& frame,
       const Options& options, const BoundedPicture& input)
      : axis_(axis),
        surface_(surface),
        materials_(materials),
        camera_(frame.camera),
        options_(options),
        input_(input) {}

  BoundedPicture run();

 private:
  using Values = std::array<Bounded, 3>;

  Bounded span_footprint(int start, int y) const;
  Values at(int x, int y, Bounded span_footprint);
  Values unchanged(int x, int y) const;
  Values scattered(int x, int y, const Rung& rung, int rotated);
  void add_center(int x, int y, const Rung& rung);
  void add_tap(int x, int y, int tap_x, int tap_y, const Rung& rung, const TapPair& pair);

  Axis axis_;
  const Surface& surface_;
  std::span<const Material> materials_;
  Camera camera_;
  const Options& options_;
  const BoundedPicture& input_;
  std::array<WeightedMean, 3> means_;
};

BoundedPicture Pass::run() {
  BoundedPicture output(surface_.width(), surface_.height());
  for (int y = 0; y < surface_.height(); ++y) {
    for (int start = 0; start < surface_.width(); start += span_px) {
      const Bounded footprint = span_footprint(start, y);
      for (int x = start; x < std::min(start + span_px, surface_.width()); ++x) {
        const Values values = at(x, y, footprint);
        for (int c = 0; c < 3; ++c) output.set(x, y, c, values[c]);
      }
    }
  }
  return output;
}

// The maximum over the pixels that a device surely scatters is its lower bound, that over those it may scatter the
// upper.
Bounded Pass::span_footprint(int start, int y) const {
  double low = 0;
  double nominal = 0;
  double high = 0;
  for (int x = start; x < std::min(start + span_px, surface_.width()); ++x) {
    const SurfacePixel& pixel = surface_.at(x, y);
    const Bounded footprint = pixel.effective_footprint[axis_];
    if (pixel.touched) nominal = std::max(nominal, footprint.value);
    if (pixel.touched && !pixel.touched_unsure) low = std::max(low, footprint.low());
    if (pixel.touched || pixel.touched_unsure) high = std::max(high, footprint.high());
  }
  return {nominal, std::max(high - nominal, nominal - low)};
}

Pass::Values Pass::unchanged(int x, int y) const {
  Values values;
  for (int c = 0; c < 3; ++c) values[c] = input_.at(x, y, c);
  return values;
}

/// Takes another outcome of a device into the bounds.
void admit(std::array<Bounded, 3>& values, const std::array<Bounded, 3>& other) {
  for (int c = 0; c < 3; ++c) {
    values[c].error = std::max(values[c].error, std::abs(other[c].value - values[c].value) + other[c].error);
  }
}

// Where a decision is too close for float32, every outcome is within the bound.
Pass::Values Pass::at(int x, int y, Bounded span_footprint) {
  const SurfacePixel& pixel = surface_.at(x, y);
  if (!pixel.touched && !pixel.touched_unsure) return unchanged(x, y);
  const Taps& taps = materials_[pixel.material].taps;
  const Choice rung = rung_choice(span_footprint, taps);
  const auto outcome = [&](int index, int rotated) {
    return index < 0 ? unchanged(x, y) : scattered(x, y, taps.rungs[index], rotated);
  };
  const auto rotated = [&](int index) {
    return index < 0 ? Choice{0, 0, 0} : rotated_choice(taps.rungs[index], taps, options_.jitter);
  };
  const int nominal = pixel.touched ? rung.nominal : -1;
  Values values = outcome(nominal, rotated(nominal).nominal);
  if (pixel.touched_unsure) admit(values, unchanged(x, y));
  for (int index = rung.lowest; index <= rung.highest; ++index) {
    const Choice turned = rotated(index);
    for (int count = turned.lowest; count <= turned.highest; ++count) {
      if (index != nominal || count != turned.nominal) admit(values, outcome(index, count));
    }
  }
  return values;
}

Pass::Values Pass::scattered(int x, int y, const Rung& rung, int rotated) {
  for (WeightedMean& mean : means_) mean.clear();
  add_center(x, y, rung);
  const Direction turned = Direction::turned(axis_, x, y, options_.seed, camera_);
  for (std::size_t i = 0; i < rung.pairs.size(); ++i) {
    const TapPair& pair = rung.pairs[i];
    PixelOffset offset{0, 0};
    offset[axis_] = pair.offset_px;
    if (static_cast<int>(i) < rotated) offset = turned.offset(pair.offset_px);
    add_tap(x, y, x + offset[0], y + offset[1], rung, pair);
    add_tap(x, y, x - offset[0], y - offset[1], rung, pair);
  }
  Values values;
  for (int c = 0; c < 3; ++c) values[c] = means_[c].mean(input_.at(x, y, c));
  return values;
}

void Pass::add_center(int x, int y, const Rung& rung) {
  const SurfacePixel& pixel = surface_.at(x, y);
  const Taps& taps = materials_[pixel.material].taps;
  for (int c = 0; c < 3; ++c) {
    const Bounded half_width = exact(rung.core_half_width_px) * pixel.segment_mm[axis_] / pixel.width_factor[c];
    means_[c].add(look_up(taps.core, c, half_width * half_width), input_.at(x, y, c));
  }
}

/// Squared distance, mm^2.
Bounded distance2(const SurfacePixel& a, const SurfacePixel& b) {
  if (&a == &b) return exact(0);
  Bounded sum = exact(0);
  for (int i = 0; i < 3; ++i) {
    const Bounded difference = a.position_mm[i] - b.position_mm[i];
    sum = sum + difference * difference;
  }
  return sum;
}

void Pass::add_tap(int x, int y, int tap_x, int tap_y, const Rung& rung, const TapPair& pair) {
  const SurfacePixel& pixel = surface_.at(x, y);
  if (!surface_.shows(pixel.material, tap_x, tap_y)) return;
  const Taps& taps = materials_[pixel.material].taps;
  const SurfacePixel& tap = surface_.at(tap_x, tap_y);
  const Bounded d2 = distance2(pixel, tap);
  const Bounded stretch = exact(rung.footprint) * tap.segment_mm[axis_];
  for (int c = 0; c < 3; ++c) {
    const Bounded k = pixel.width_factor[c];
    const Bounded falloff = look_up(taps.falloff, c, d2 / (k * k));
    means_[c].add(stretch * exact(pair.length_mm[c]) * falloff / k, input_.at(tap_x, tap_y, c));
  }
}

}  // namespace

Reference separable(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Surface surface(frame, images, materials);
  const Light light(images, options);
  const BoundedPicture x = light.filtered();
  const BoundedPicture across = Pass(horizontal, surface, materials, frame, options, x).run();
  const BoundedPicture scattered = Pass(vertical, surface, materials, frame, options, across).run();
  return recompose(surface, light, scattered);
}

}  // namespace dermis::oracle
