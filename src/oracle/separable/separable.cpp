#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/classify/block.hpp"
#include "oracle/frame/compose.hpp"
#include "oracle/frame/entering_light.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/rotation.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/weighted_sum.hpp"
#include "oracle/separable/choice.hpp"
#include "oracle/separable/tap_weights.hpp"

namespace dermis::oracle {

namespace {

/// The light of a pixel after a pass: that of each term, or their sum alone.
using Outcome = std::vector<BoundedRgb>;

/// Widens the bounds of an outcome so that they admit another one, which a device may have.
void admit(Outcome& outcome, const Outcome& other) {
  for (std::size_t t = 0; t < outcome.size(); ++t) {
    for (int c = 0; c < 3; ++c) outcome[t][c] = including(outcome[t][c], other[t][c]);
  }
}

/// Returns the sum over terms of scale times value, which a device may add up in any order.
Bounded scaled_sum(const Outcome& values, std::span<const Term> terms, int c) {
  if (terms.size() == 1) return exact(terms[0].scale[c]) * values[0][c];
  Bounded sum;
  double magnitudes = 0;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const Bounded scaled = exact(terms[t].scale[c]) * values[t][c];
    sum.value += scaled.value;
    sum.error += scaled.error + 2 * smallest_normal;  // The product and the sum may be flushed to zero.
    magnitudes += scaled.magnitude();
  }
  sum.error += static_cast<double>(terms.size()) * unit_roundoff * magnitudes;
  return sum;
}

/// What both passes work on.
struct SeparableFrame {
  const Surface& surface;
  const Blocks& blocks;
  std::span<const Material> materials;
  const Camera& camera;
  const Options& options;
  const BoundedPicture& light;  ///< before the passes
};

/// Returns 1 / max(1, weights), which is bounded whatever the error of the weights.
Bounded limit_of(Bounded weights) {
  const auto at = [](double its) { return 1 / std::max(its, 1.0); };
  const double value = at(weights.value);
  return rounded({value, std::max(at(weights.low()) - value, value - at(weights.high()))}, division_roundings);
}

/// One pass over a frame, along one axis. The horizontal one makes a picture of each term, the vertical one reads those
/// and makes one picture of the sum over terms.
class Pass {
 public:
  /// `inputs` holds the picture that each term reads.
  Pass(Axis axis, const SeparableFrame& frame, std::span<const BoundedPicture> inputs)
      : axis_(axis), frame_(frame), surface_(frame.surface), inputs_(inputs) {}

  /// Overwrites the pixels of `outputs` that give light.
  void run(std::span<BoundedPicture> outputs);

 private:
  const Taps& taps_at(int x, int y) const { return frame_.materials[surface_.at(x, y).material].taps; }
  BoundedRgb input(std::size_t term, int x, int y) const;
  Outcome outcome(int x, int y, std::span<const BlockPass> passes);
  Outcome source(int x, int y) const;
  Outcome without_taps(int x, int y) const;
  Outcome with_taps(int x, int y, const Choice& choice);
  void add_center(int x, int y, const TapWeights& weights);
  std::vector<PixelOffset> sheared(int x, int y, int offset_px, const Choice& choice) const;
  struct Reading;
  Reading read(int x, int y, const TapWeights& weights, std::size_t pair, PixelOffset offset) const;
  void add_tap(int x, int y, const TapWeights& weights, std::size_t pair, const std::vector<PixelOffset>& offsets);
  void add_channel(std::span<const Reading> readings, const TapWeights& weights, std::size_t term, int channel);
  Outcome finished(const Outcome& values, std::span<const Term> terms) const;

  Axis axis_;
  const SeparableFrame& frame_;
  const Surface& surface_;
  std::span<const BoundedPicture> inputs_;
  std::vector<std::array<WeightedSum, 3>> sums_;  ///< of each term
};

void Pass::run(std::span<BoundedPicture> outputs) {
  const Blocks& blocks = frame_.blocks;
  for (int row = 0; row < blocks.rows(); ++row) {
    for (int column = 0; column < blocks.columns(); ++column) {
      const std::vector<BlockPass> passes = blocks.classify(axis_, column, row);
      blocks.for_each_pixel(column, row, [&](int x, int y) {
        if (!surface_.at(x, y).gives_light()) return;
        const Outcome values = outcome(x, y, passes);
        for (std::size_t t = 0; t < values.size(); ++t) {
          for (int c = 0; c < 3; ++c) outputs[t].set(x, y, c, values[t][c]);
        }
      });
    }
  }
}

BoundedRgb Pass::input(std::size_t term, int x, int y) const {
  BoundedRgb values;
  for (int c = 0; c < 3; ++c) values[c] = inputs_[term].at(x, y, c);
  return values;
}

// Where a decision is too close for float32, the bound admits every outcome.
Outcome Pass::outcome(int x, int y, std::span<const BlockPass> passes) {
  const SurfacePixel& pixel = surface_.at(x, y);
  const bool takes = pixel.takes_light();
  if (!takes && !pixel.takes_light_unsure()) return source(x, y);
  const std::vector<Choice> all = choices(passes, taps_at(x, y), frame_.options.jitter);
  const auto by = [&](const Choice& choice) { return choice.level < 0 ? without_taps(x, y) : with_taps(x, y, choice); };
  Outcome result = takes ? by(all.front()) : source(x, y);
  if (pixel.takes_light_unsure()) admit(result, source(x, y));
  for (std::size_t i = takes ? 1 : 0; i < all.size(); ++i) admit(result, by(all[i]));
  return result;
}

/// A pixel that gives light but takes none shows it to the vertical pass, which restores the pixel.
Outcome Pass::source(int x, int y) const {
  if (axis_ == horizontal) return without_taps(x, y);
  BoundedRgb values;
  for (int c = 0; c < 3; ++c) values[c] = frame_.light.at(x, y, c);
  return {values};
}

/// Where a kernel is too narrow for taps, each term is its sum at one point.
Outcome Pass::without_taps(int x, int y) const {
  const std::span<const Term> terms = taps_at(x, y).terms;
  Outcome values;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    values.push_back(input(t, x, y));
    if (terms[t].normalised) continue;
    for (int c = 0; c < 3; ++c) values[t][c] = exact(terms[t].sum[c]) * values[t][c];
  }
  return finished(values, terms);
}

/// A tap that may have fallen on some pixel.
struct Pass::Reading {
  bool is_there;  ///< The pixel is of the material and gives light.
  TapWeights::Place place;
  int x, y;
};

Outcome Pass::with_taps(int x, int y, const Choice& choice) {
  const Taps& taps = taps_at(x, y);
  const TapLevel& level = taps.levels[choice.level];
  const TapWeights weights(axis_, surface_, x, y, taps, choice);
  sums_.resize(taps.terms.size());
  for (auto& sum : sums_) {
    for (WeightedSum& channel : sum) channel.clear();
  }
  add_center(x, y, weights);
  const Direction turned = Direction::turned(axis_, x, y, frame_.options.seed, frame_.camera);
  for (std::size_t pair = 0; pair < level.offsets_px.size(); ++pair) {
    for (const int side : {1, -1}) {
      const int offset_px = side * level.offsets_px[pair];
      if (static_cast<int>(pair) < choice.rotated) {
        const auto [dx, dy] = turned.offset(level.offsets_px[pair]);
        add_tap(x, y, weights, pair, {{side * dx, side * dy}});
      } else if (axis_ == horizontal) {
        add_tap(x, y, weights, pair, {{offset_px, 0}});
      } else {
        add_tap(x, y, weights, pair, sheared(x, y, offset_px, choice));
      }
    }
  }
  BoundedRgb limit{exact(1), exact(1), exact(1)};  // of the weights of differences, on a curved surface
  if (choice.block_class == BlockClass::curved) {
    for (int c = 0; c < 3; ++c) limit[c] = limit_of(sums_[0][c].weights());
  }
  Outcome values;
  for (std::size_t t = 0; t < taps.terms.size(); ++t) {
    const Term& term = taps.terms[t];
    values.push_back(input(t, x, y));
    for (int c = 0; c < 3; ++c) {
      WeightedSum& sum = sums_[t][c];
      const Bounded own = values[t][c];
      if (!term.normalised) sum.scale(limit[c]);
      values[t][c] = term.normalised ? sum.mean(own) : sum.about(own, term.sum[c]);
    }
  }
  return finished(values, taps.terms);
}

/// Only a mean weighs the pixel itself.
void Pass::add_center(int x, int y, const TapWeights& weights) {
  const std::span<const Term> terms = taps_at(x, y).terms;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    if (!terms[t].normalised) continue;
    for (int c = 0; c < 3; ++c) {
      const Bounded weight = weights.center(t, c);
      sums_[t][c].add(weight, inputs_[t].at(x, y, c), std::max(weight.low(), weights.least_center()));
    }
  }
}

/// Returns where a tap of the vertical pass may lie, the oracle's place first.
std::vector<PixelOffset> Pass::sheared(int x, int y, int offset_px, const Choice& choice) const {
  const bool has_own = choice.block_class == BlockClass::curved;
  std::vector<PixelOffset> offsets;
  for (const int side : sides_px(has_own ? surface_.shear(x, y) : choice.shear, offset_px,
                                 has_own ? most_curved_side_px : most_flat_side_px)) {
    offsets.push_back({side, offset_px});
  }
  return offsets;
}

Pass::Reading Pass::read(int x, int y, const TapWeights& weights, std::size_t pair, PixelOffset offset) const {
  Reading reading{false, {}, x + offset[0], y + offset[1]};
  if (!surface_.shows(surface_.at(x, y).material, reading.x, reading.y)) return reading;
  if (!surface_.at(reading.x, reading.y).gives_light()) return reading;
  reading.is_there = true;
  reading.place = weights.place(reading.x, reading.y, pair);
  return reading;
}

/// Adds one tap, which may have fallen on any of these pixels, to the sums of every term.
void Pass::add_tap(int x, int y, const TapWeights& weights, std::size_t pair, const std::vector<PixelOffset>& offsets) {
  std::vector<Reading> readings;
  readings.reserve(offsets.size());
  for (const PixelOffset offset : offsets) readings.push_back(read(x, y, weights, pair, offset));
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    for (int c = 0; c < 3; ++c) add_channel(readings, weights, t, c);
  }
}

void Pass::add_channel(std::span<const Reading> readings, const TapWeights& weights, std::size_t term, int channel) {
  Bounded weight;
  double least_weight = std::numeric_limits<double>::infinity();
  Bounded light;
  bool has_light = false;
  for (const Reading& reading : readings) {
    const Bounded here = reading.is_there ? weights.tap(reading.place, term, channel) : exact(0);
    weight = &reading == &readings.front() ? here : including(weight, here);
    least_weight = std::min(least_weight, here.low());
    if (!reading.is_there) continue;
    const Bounded light_here = inputs_[term].at(reading.x, reading.y, channel);
    light = has_light ? including(light, light_here) : light_here;
    has_light = true;
  }
  if (has_light && !is_exactly(weight, 0)) sums_[term][channel].add(weight, light, least_weight);
}

Outcome Pass::finished(const Outcome& values, std::span<const Term> terms) const {
  if (axis_ == horizontal) return values;
  BoundedRgb sums;
  for (int c = 0; c < 3; ++c) sums[c] = scaled_sum(values, terms, c);
  return {sums};
}

/// Returns whether no pixel has a width of its own and no tap is rotated.
bool may_be_flat(const FrameImages& images, std::span<const Material> materials, const Options& options) {
  return !is_there(images.mask) && options.jitter == 0 &&
         std::none_of(materials.begin(), materials.end(), [](const Material& m) { return m.albedo_width.has_value(); });
}

std::size_t most_terms(std::span<const Material> materials) {
  std::size_t most = 0;
  for (const Material& material : materials) most = std::max(most, material.taps.terms.size());
  return most;
}

}  // namespace

Reference separable(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Light light(images, options);
  const Surface surface(frame, images, materials, light, options.sheared && options.jitter == 0);
  const Blocks blocks(surface, materials, may_be_flat(images, materials, options));
  const BoundedPicture before = light.filtered();
  const BoundedPicture entering = entering_light(surface, images, materials, options, before);
  const SeparableFrame both{surface, blocks, materials, frame.camera, options, before};
  const std::vector<BoundedPicture> inputs(most_terms(materials), entering);
  std::vector<BoundedPicture> between = inputs;
  Pass(horizontal, both, inputs).run(between);
  BoundedPicture after = before;
  Pass(vertical, both, between).run(std::span(&after, 1));
  return compose(surface, light, after);
}

}  // namespace dermis::oracle
