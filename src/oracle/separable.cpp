#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/choice.hpp"
#include "oracle/frame_images.hpp"
#include "oracle/light.hpp"
#include "oracle/recompose.hpp"
#include "oracle/rotation.hpp"
#include "oracle/surface.hpp"
#include "oracle/tap_weights.hpp"
#include "oracle/weighted_sum.hpp"

namespace dermis::oracle {

namespace {

constexpr int span_px = 16;

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
  Pass(Axis axis, const Surface& surface, std::span<const Material> materials, const Frame& frame,
       const Options& options, const BoundedPicture& light)
      : axis_(axis),
        surface_(surface),
        materials_(materials),
        camera_(frame.camera),
        options_(options),
        light_(light) {}

  /// `inputs`: what each term reads. Fills `outputs`, which hold the light so far.
  void run(std::span<const BoundedPicture> inputs, std::span<BoundedPicture> outputs);

 private:
  Bounded span_footprint(int start, int y) const;
  std::span<const Term> terms_of(int x, int y) const { return materials_[surface_.at(x, y).material].taps.terms; }
  Values input(std::size_t term, int x, int y) const;
  Outcome at(int x, int y, Bounded span_footprint);
  Outcome source(int x, int y) const;
  Outcome without_taps(int x, int y) const;
  Outcome with_taps(int x, int y, const Rung& rung, int rotated);
  void add_center(int x, int y, const TapWeights& weights);
  void add_tap(int x, int y, int tap_x, int tap_y, const TapWeights& weights, std::size_t pair);
  Outcome finished(const Outcome& values, std::span<const Term> terms) const;

  Axis axis_;
  const Surface& surface_;
  std::span<const Material> materials_;
  Camera camera_;
  const Options& options_;
  const BoundedPicture& light_;
  std::span<const BoundedPicture> inputs_;
  std::vector<std::array<WeightedSum, 3>> sums_;  ///< of each term
};

void Pass::run(std::span<const BoundedPicture> inputs, std::span<BoundedPicture> outputs) {
  inputs_ = inputs;
  for (int y = 0; y < surface_.height(); ++y) {
    for (int start = 0; start < surface_.width(); start += span_px) {
      const Bounded footprint = span_footprint(start, y);
      for (int x = start; x < std::min(start + span_px, surface_.width()); ++x) {
        if (surface_.at(x, y).material < 0) continue;
        const Outcome outcome = at(x, y, footprint);
        for (std::size_t t = 0; t < outcome.size(); ++t) {
          for (int c = 0; c < 3; ++c) outputs[t].set(x, y, c, outcome[t][c]);
        }
      }
    }
  }
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

Values Pass::input(std::size_t term, int x, int y) const {
  Values values;
  for (int c = 0; c < 3; ++c) values[c] = inputs_[term].at(x, y, c);
  return values;
}

// Where a decision is too close for float32, every outcome is within the bound.
Outcome Pass::at(int x, int y, Bounded span_footprint) {
  const SurfacePixel& pixel = surface_.at(x, y);
  if (!pixel.touched && !pixel.touched_unsure) return source(x, y);
  const Taps& taps = materials_[pixel.material].taps;
  const Choice rung = rung_choice(span_footprint, taps);
  const auto outcome = [&](int index, int rotated) {
    return index < 0 ? without_taps(x, y) : with_taps(x, y, taps.rungs[index], rotated);
  };
  const auto rotated = [&](int index) {
    return index < 0 ? Choice{0, 0, 0} : rotated_choice(taps.rungs[index], taps, options_.jitter);
  };
  Outcome result = pixel.touched ? outcome(rung.nominal, rotated(rung.nominal).nominal) : source(x, y);
  if (pixel.touched_unsure) admit(result, source(x, y));
  for (int index = rung.lowest; index <= rung.highest; ++index) {
    const Choice turned = rotated(index);
    for (int count = turned.lowest; count <= turned.highest; ++count) {
      const bool is_nominal = pixel.touched && index == rung.nominal && count == turned.nominal;
      if (!is_nominal) admit(result, outcome(index, count));
    }
  }
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

Outcome Pass::with_taps(int x, int y, const Rung& rung, int rotated) {
  const SurfacePixel& pixel = surface_.at(x, y);
  const Taps& taps = materials_[pixel.material].taps;
  const TapWeights weights(axis_, pixel, taps, rung);
  sums_.resize(taps.terms.size());
  for (auto& sum : sums_) {
    for (WeightedSum& channel : sum) channel.clear();
  }
  add_center(x, y, weights);
  const Direction turned = Direction::turned(axis_, x, y, options_.seed, camera_);
  for (std::size_t i = 0; i < rung.offsets_px.size(); ++i) {
    PixelOffset offset{0, 0};
    offset[axis_] = rung.offsets_px[i];
    if (static_cast<int>(i) < rotated) offset = turned.offset(rung.offsets_px[i]);
    add_tap(x, y, x + offset[0], y + offset[1], weights, i);
    add_tap(x, y, x - offset[0], y - offset[1], weights, i);
  }
  Outcome values;
  for (std::size_t t = 0; t < taps.terms.size(); ++t) {
    const Term& term = taps.terms[t];
    values.push_back(input(t, x, y));
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
    for (int c = 0; c < 3; ++c) sums_[t][c].add(weights.center(t, c), inputs_[t].at(x, y, c));
  }
}

void Pass::add_tap(int x, int y, int tap_x, int tap_y, const TapWeights& weights, std::size_t pair) {
  if (!surface_.shows(surface_.at(x, y).material, tap_x, tap_y)) return;
  const TapWeights::Place place = weights.place(surface_.at(tap_x, tap_y));
  for (std::size_t t = 0; t < sums_.size(); ++t) {
    for (int c = 0; c < 3; ++c) sums_[t][c].add(weights.tap(place, pair, t, c), inputs_[t].at(tap_x, tap_y, c));
  }
}

Outcome Pass::finished(const Outcome& values, std::span<const Term> terms) const {
  if (axis_ == horizontal) return values;
  Values sums;
  for (int c = 0; c < 3; ++c) sums[c] = scaled_sum(values, terms, c);
  return {sums};
}

std::size_t most_terms(std::span<const Material> materials) {
  std::size_t most = 0;
  for (const Material& material : materials) most = std::max(most, material.taps.terms.size());
  return most;
}

}  // namespace

Reference separable(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Surface surface(frame, images, materials);
  const Light light(images, options);
  const BoundedPicture x = light.filtered();
  const std::vector<BoundedPicture> lights(most_terms(materials), x);
  std::vector<BoundedPicture> across = lights;
  Pass(horizontal, surface, materials, frame, options, x).run(lights, across);
  BoundedPicture scattered = x;
  Pass(vertical, surface, materials, frame, options, x).run(across, std::span(&scattered, 1));
  return recompose(surface, light, scattered);
}

}  // namespace dermis::oracle
