#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/classify/block.hpp"
#include "oracle/frame/compose.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/rotation.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/weighted_sum.hpp"
#include "oracle/separable/choice.hpp"
#include "oracle/separable/tap_weights.hpp"

namespace dermis::oracle {

namespace {

using Values = std::array<Bounded, 3>;
using Outcome = std::vector<Values>;  ///< of a pass at a pixel: of each term, or the only one of the sum over terms

/// Takes another outcome of a device into the bounds.
void admit(Outcome& outcome, const Outcome& other) {
  for (std::size_t t = 0; t < outcome.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      Bounded& value = outcome[t][c];
      value.error = std::max(value.error, std::abs(other[t][c].value - value.value) + other[t][c].error);
    }
  }
}

/// The sum over terms of scale times value, added up in any order.
Bounded scaled_sum(const Outcome& values, std::span<const Term> terms, int c) {
  if (terms.size() == 1) return exact(terms[0].scale[c]) * values[0][c];
  Bounded sum;
  double magnitudes = 0;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const Bounded scaled = exact(terms[t].scale[c]) * values[t][c];
    sum.value += scaled.value;
    sum.error += scaled.error + 2 * smallest_normal;  // product or sum flushed to zero
    magnitudes += scaled.magnitude();
  }
  sum.error += static_cast<double>(terms.size()) * unit_roundoff * magnitudes;
  return sum;
}

/// One pass over a frame, along one axis. The horizontal one makes a picture of each term, the vertical one reads those
/// and makes one picture of the sum over terms.
class Pass {
 public:
  Pass(Axis axis, const Surface& surface, const Blocks& blocks, std::span<const Material> materials, const Frame& frame,
       const Options& options, const BoundedPicture& light)
      : axis_(axis),
        surface_(surface),
        blocks_(blocks),
        materials_(materials),
        camera_(frame.camera),
        options_(options),
        light_(light) {}

  /// `inputs`: what each term reads. Fills `outputs`, which hold the light so far.
  void run(std::span<const BoundedPicture> inputs, std::span<BoundedPicture> outputs);

 private:
  std::span<const Term> terms_of(int x, int y) const { return materials_[surface_.at(x, y).material].taps.terms; }
  Values input(std::size_t term, int x, int y) const;
  Outcome at(int x, int y, std::span<const BlockClass> kinds);
  Outcome source(int x, int y) const;
  Outcome without_taps(int x, int y) const;
  Outcome with_taps(int x, int y, const Way& way);
  void add_center(int x, int y, const TapWeights& weights);
  void add(std::size_t term, int c, const WeightParts& parts, int x, int y);
  std::vector<PixelOffset> sheared(int x, int y, int offset_px, const Way& way) const;
  struct Reading;
  const SurfacePixel* tap_at(int x, int y, PixelOffset offset) const;
  void add_tap(int x, int y, std::span<const PixelOffset> offsets, int side, const TapWeights& weights,
               std::size_t pair);
  void add_readings(std::span<const Reading> readings, const TapWeights& weights, std::size_t pair, std::size_t term,
                    int c);
  Outcome finished(const Outcome& values, std::span<const Term> terms) const;

  Axis axis_;
  const Surface& surface_;
  const Blocks& blocks_;
  std::span<const Material> materials_;
  Camera camera_;
  const Options& options_;
  const BoundedPicture& light_;
  std::span<const BoundedPicture> inputs_;
  std::vector<std::array<WeightedSum, 3>> sums_;  ///< of each term
};

void Pass::run(std::span<const BoundedPicture> inputs, std::span<BoundedPicture> outputs) {
  inputs_ = inputs;
  for (int row = 0; row < blocks_.rows(); ++row) {
    for (int column = 0; column < blocks_.columns(); ++column) {
      const std::vector<BlockClass> kinds = blocks_.kinds(axis_, column, row);
      blocks_.for_each_pixel(column, row, [&](int x, int y) {
        if (!surface_.at(x, y).gives_light()) return;
        const Outcome outcome = at(x, y, kinds);
        for (std::size_t t = 0; t < outcome.size(); ++t) {
          for (int c = 0; c < 3; ++c) outputs[t].set(x, y, c, outcome[t][c]);
        }
      });
    }
  }
}

Values Pass::input(std::size_t term, int x, int y) const {
  Values values;
  for (int c = 0; c < 3; ++c) values[c] = inputs_[term].at(x, y, c);
  return values;
}

// Where a decision is too close for float32, every outcome is within the bound.
Outcome Pass::at(int x, int y, std::span<const BlockClass> kinds) {
  const SurfacePixel& pixel = surface_.at(x, y);
  const bool takes = pixel.takes_light();
  if (!takes && !pixel.takes_light_unsure()) return source(x, y);
  const std::vector<Way> all = ways(kinds, materials_[pixel.material].taps, options_.jitter);
  const auto outcome = [&](const Way& way) { return way.level < 0 ? without_taps(x, y) : with_taps(x, y, way); };
  Outcome result = takes ? outcome(all.front()) : source(x, y);
  if (pixel.takes_light_unsure()) admit(result, source(x, y));
  for (std::size_t i = takes ? 1 : 0; i < all.size(); ++i) admit(result, outcome(all[i]));
  return result;
}

/// Of a pixel that gives light but takes none: the second pass makes of it what it was.
Outcome Pass::source(int x, int y) const {
  if (axis_ == horizontal) return without_taps(x, y);
  Values values;
  for (int c = 0; c < 3; ++c) values[c] = light_.at(x, y, c);
  return {values};
}

/// Of a kernel too narrow for taps: each term is its sum at one point.
Outcome Pass::without_taps(int x, int y) const {
  const std::span<const Term> terms = terms_of(x, y);
  Outcome values;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    values.push_back(input(t, x, y));
    if (terms[t].normalised) continue;
    for (int c = 0; c < 3; ++c) values[t][c] = exact(terms[t].sum[c]) * values[t][c];
  }
  return finished(values, terms);
}

Outcome Pass::with_taps(int x, int y, const Way& way) {
  const SurfacePixel& pixel = surface_.at(x, y);
  const Taps& taps = materials_[pixel.material].taps;
  const TapLevel& level = taps.levels[way.level];
  const TapWeights weights(axis_, surface_, x, y, taps, way);
  sums_.resize(taps.terms.size());
  for (auto& sum : sums_) {
    for (WeightedSum& channel : sum) channel.clear();
  }
  add_center(x, y, weights);
  const Direction turned = Direction::turned(axis_, x, y, options_.seed, camera_);
  for (std::size_t i = 0; i < level.offsets_px.size(); ++i) {
    for (const int side : {1, -1}) {
      const int offset_px = side * level.offsets_px[i];
      if (static_cast<int>(i) < way.rotated) {
        const auto [dx, dy] = turned.offset(level.offsets_px[i]);
        add_tap(x, y, {{{side * dx, side * dy}}}, side, weights, i);
      } else if (axis_ == horizontal) {
        add_tap(x, y, {{{offset_px, 0}}}, side, weights, i);
      } else {
        add_tap(x, y, sheared(x, y, offset_px, way), side, weights, i);
      }
    }
  }
  std::array<Bounded, 3> limit{exact(1), exact(1), exact(1)};  // of differences, on a curved surface
  if (way.shape == Shape::curved) {
    for (int c = 0; c < 3; ++c) limit[c] = exact(1) / larger(sums_[0][c].weights(), exact(1));
  }
  Outcome values;
  for (std::size_t t = 0; t < taps.terms.size(); ++t) {
    const Term& term = taps.terms[t];
    values.push_back(input(t, x, y));
    if (!term.normalised) {
      for (int c = 0; c < 3; ++c) sums_[t][c].scale(limit[c]);
    }
    for (int c = 0; c < 3; ++c) {
      const Bounded own = values[t][c];
      values[t][c] = term.normalised ? sums_[t][c].mean(own) : sums_[t][c].about(own, term.sum[c]);
    }
  }
  return finished(values, taps.terms);
}

/// Only a mean weighs the pixel itself.
void Pass::add_center(int x, int y, const TapWeights& weights) {
  const std::span<const Term> terms = terms_of(x, y);
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (!terms[t].normalised) continue;
    for (int c = 0; c < 3; ++c) add(t, c, weights.center(t, c), x, y);
  }
}

void Pass::add(std::size_t term, int c, const WeightParts& parts, int x, int y) {
  for (const Bounded& part : parts) {
    if (!is_exactly(part, 0)) sums_[term][c].add(part, inputs_[term].at(x, y, c));
  }
}

/// What a tap may fall on.
struct Pass::Reading {
  bool is_there;
  TapWeights::Place place;
  int x, y;
};

/// Where a tap of the vertical pass may lie: the oracle's place first.
std::vector<PixelOffset> Pass::sheared(int x, int y, int offset_px, const Way& way) const {
  std::vector<PixelOffset> offsets;
  for (const int side : sides_px(way.shape == Shape::curved ? surface_.shear(x, y) : way.shear, offset_px)) {
    offsets.push_back({side, offset_px});
  }
  return offsets;
}

/// What a tap reads, if it is of the pixel's material and gives light.
const SurfacePixel* Pass::tap_at(int x, int y, PixelOffset offset) const {
  const int tap_x = x + offset[0];
  const int tap_y = y + offset[1];
  if (!surface_.shows(surface_.at(x, y).material, tap_x, tap_y)) return nullptr;
  const SurfacePixel& tap = surface_.at(tap_x, tap_y);
  return tap.gives_light() ? &tap : nullptr;
}

void Pass::add_tap(int x, int y, std::span<const PixelOffset> offsets, int side, const TapWeights& weights,
                   std::size_t pair) {
  std::vector<Reading> readings;
  for (const PixelOffset offset : offsets) {
    const SurfacePixel* tap = tap_at(x, y, offset);
    readings.push_back({tap != nullptr, tap != nullptr ? weights.place(*tap, side) : TapWeights::Place{}, x + offset[0],
                        y + offset[1]});
  }
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    for (int c = 0; c < 3; ++c) add_readings(readings, weights, pair, t, c);
  }
}

/// One tap in one channel of one term, which may have fallen on any of these.
void Pass::add_readings(std::span<const Reading> readings, const TapWeights& weights, std::size_t pair,
                        std::size_t term, int c) {
  WeightParts parts{};
  Bounded light;
  bool has_light = false;
  for (const Reading& reading : readings) {
    const WeightParts its = reading.is_there ? weights.tap(reading.place, pair, term, c) : WeightParts{};
    const bool is_first = &reading == &readings.front();
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = is_first ? its[i] : including(parts[i], its[i]);
    if (!reading.is_there) continue;
    const Bounded its_light = inputs_[term].at(reading.x, reading.y, c);
    light = has_light ? including(light, its_light) : its_light;
    has_light = true;
  }
  if (!has_light) return;
  for (const Bounded& part : parts) {
    if (!is_exactly(part, 0)) sums_[term][c].add(part, light);
  }
}

Outcome Pass::finished(const Outcome& values, std::span<const Term> terms) const {
  if (axis_ == horizontal) return values;
  Values sums;
  for (int c = 0; c < 3; ++c) sums[c] = scaled_sum(values, terms, c);
  return {sums};
}

/// No pixel has a width of its own and no tap is rotated.
bool may_be_flat(const FrameImages& images, std::span<const Material> materials, const Options& options) {
  return !is_there(images.mask) && options.jitter == 0 &&
         std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.width_follows_albedo; });
}

std::size_t most_terms(std::span<const Material> materials) {
  std::size_t most = 0;
  for (const Material& material : materials) most = std::max(most, material.taps.terms.size());
  return most;
}

}  // namespace

Reference separable(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Surface surface(frame, images, materials, options.sheared && options.jitter == 0);
  const Blocks blocks(surface, materials, may_be_flat(images, materials, options));
  const Light light(images, options);
  const BoundedPicture x = light.filtered();
  const std::vector<BoundedPicture> lights(most_terms(materials), x);
  std::vector<BoundedPicture> across = lights;
  Pass(horizontal, surface, blocks, materials, frame, options, x).run(lights, across);
  BoundedPicture scattered = x;
  Pass(vertical, surface, blocks, materials, frame, options, x).run(across, std::span(&scattered, 1));
  return recompose(surface, light, scattered);
}

}  // namespace dermis::oracle
