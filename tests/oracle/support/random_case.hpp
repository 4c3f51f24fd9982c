// Random frames, materials and options, to test the oracle's bounds.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "dermis/plan.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

/// Returns a Gaussian with levels for kernels of 1/2 to 32 px, whose taps lie `step_px` apart.
inline Material level_material(double sigma_mm, int id, int step_px) {
  Material material = gaussian_material(sigma_mm, 1, id);
  Taps& taps = material.taps;
  taps.relative_width = {1, 0.9F, 0.7F};
  std::vector<TapLevel> levels;
  for (int i = 0; i < 6 * 16; ++i) {
    const double radius_px = std::ldexp(0.5 * (1 + (i % 16 + 0.5) / 16), i / 16);
    std::vector<int> offsets_px;
    for (int offset = step_px; offset < radius_px; offset += step_px) offsets_px.push_back(offset);
    levels.push_back(gaussian_level(sigma_mm, radius_px / taps.radius_mm, offsets_px, step_px));
  }
  const RowWeights rows = gaussian_rows(sigma_mm, step_px);
  for (TapLevel& level : levels) {
    // Some taps have an end within reach.
    for (std::size_t row = 1; row < level.nearness.size(); ++row) {
      level.nearness[row].end = 0.05F * static_cast<float>(row % 3);
    }
  }
  set_levels(taps, levels, [&](const TapLevel& level, std::size_t row) {
    // A part of a pair's weight goes with lower powers of the nearness, and channels differ.
    const auto& [a, b, c] = rows(level, row);
    if (row == 0) return CubicWeight{a, b, c};
    return CubicWeight{
        {{0.25F * c[0], 0, 0.5F * c[2]}, {0, 0.4F * c[1], -0.1F * c[2]}, {0.75F * c[0], 0.5F * c[1], 0.7F * c[2]}}};
  });
  return material;
}

/// Gives all levels random flat weights, which have nothing to do with those by distance.
inline void lay_random_flat(Random& random, Taps& taps) {
  for (TapLevel& level : taps.levels) {
    const auto taps_of_level = static_cast<double>(2 * level.offsets_px.size() + 1);
    lay_flat(level, taps.terms, [&](std::size_t, std::size_t t, std::size_t) {
      return random.uniform(taps.terms[t].normalised ? 0 : -1, 1) /
             taps_of_level;  // The weights of a mean do not cancel.
    });
  }
}

/// Adds up to `most` terms, means or differences, whose taps differ from level to level.
inline void add_terms(Random& random, Taps& taps, int most) {
  const auto any = [&](double low, double high) {
    std::array<float, 3> values{};
    for (float& value : values) value = static_cast<float>(random.uniform(low, high));
    return values;
  };
  for (int t = random.integer(0, most); t > 0; --t) {
    const bool normalised = random.coin();
    const Term term{grey(1), normalised, random.coin() ? std::array<float, 3>{} : any(-1, 1)};
    add_term(taps, term, [&](const TapLevel& level, std::size_t row) {
      // The weights of a mean do not cancel. Its centre may be the least one, a difference has none.
      const double most_weight =
          row == 0 ? (normalised ? 1 : 0) : random.uniform(0, 1) / static_cast<double>(level.offsets_px.size());
      const double least_weight = normalised ? 0 : -most_weight;
      return CubicWeight{any(least_weight, most_weight), any(least_weight, most_weight),
                         any(least_weight, most_weight)};
    });
  }
  for (Term& term : taps.terms) term.scale = any(-1, 1);
  taps.terms[0].scale = any(0.5, 1.5);
}

inline std::vector<float> noise(Random& random, std::size_t count, double low, double high) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(random.uniform(low, high)));
  return values;
}

/// Adds a surface about a distance, which may be tilted, bent, rough, broken, or none of it.
inline void add_depth(Random& random, MadeFrame& made, double distance_mm, double pixel_mm) {
  const double longest_px = std::max(made.width, made.height);
  const double largest_slope = std::min(1.5 * pixel_mm, 0.3 * distance_mm / longest_px);
  const double slope_x = random.coin() ? random.uniform(-1, 1) * largest_slope : 0;
  const double slope_y = random.coin() ? random.uniform(-1, 1) * largest_slope : 0;
  const double bend = random.coin() ? random.uniform(0, 1) * largest_slope / longest_px : 0;
  const double roughness[] = {0, 0.01, 0.1, 0.3, 1};
  const double rough_mm = roughness[random.integer(0, 4)] * pixel_mm;
  const double step_mm = random.coin() ? random.uniform(0, 3) * pixel_mm : 0;
  const int step_at = random.integer(0, made.width);
  for (int y = 0; y < made.height; ++y) {
    for (int x = 0; x < made.width; ++x) {
      const double z_mm = distance_mm + slope_x * x + slope_y * y + bend * x * x / 2 + random.uniform(0, rough_mm) +
                          (x >= step_at ? step_mm : 0);
      made.depth.push_back(static_cast<float>(z_mm / made.mm_per_unit));
    }
  }
}

/// A `plain` frame has no mask, so that blocks may be flat.
inline MadeFrame random_frame(Random& random, int width, int height, bool plain) {
  const double pixels_per_mm = random.uniform(1, 6);
  const bool perspective = random.coin();
  const double distance = random.uniform(20, 200);
  const double mm_per_unit = random.coin() ? 1 : random.uniform(0.1, 20);
  const double scale = pixels_per_mm * (perspective ? distance : mm_per_unit);
  Camera camera{perspective ? Camera::Projection::perspective : Camera::Projection::orthographic, scale,
                scale * random.uniform(0.7, 1.4), random.uniform(0, width), random.uniform(0, height)};
  MadeFrame made(width, height, camera);
  made.mm_per_unit = mm_per_unit;
  if (perspective || random.integer(0, 3) > 0) add_depth(random, made, distance, 1 / pixels_per_mm);
  made.light = noise(random, 3 * made.pixels(), 0, random.coin() ? 1 : 1000);
  if (!plain && random.coin()) made.mask = noise(random, made.pixels(), 0.02, 1.2);
  if (random.integer(0, 3) == 0) {
    // Some pixels of the left half are covered in part, or not at all, or by more than 1.
    made.matte.assign(made.pixels(), 1);
    for (std::size_t i = 0; i < made.pixels(); ++i) {
      const bool is_left = 2 * (static_cast<int>(i) % made.width) < made.width;
      if (is_left && random.integer(0, 9) == 0) made.matte[i] = static_cast<float>(random.uniform(-0.2, 1.2));
    }
  }
  made.albedo = noise(random, 3 * made.pixels(), -0.05, 1.1);
  made.beauty = noise(random, 3 * made.pixels(), 0, 2);
  const bool mixed = random.coin();
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const bool left = i % static_cast<std::size_t>(width) < 9;
    made.material.push_back(static_cast<float>(mixed ? random.integer(0, 20) / 9 : (left ? 1 : 0)));
    if (random.integer(0, 99) == 0) made.light[3 * i + 1] = std::numeric_limits<float>::quiet_NaN();
  }
  return made;
}

inline Options random_options(Random& random, bool plain) {
  Options options;
  options.jitter = plain || random.coin() ? 0 : random.uniform(0, 1);
  options.sheared = random.coin() || random.coin();
  options.seed = static_cast<std::uint32_t>(random.integer(0, 1 << 30));
  options.lighting = random.coin() ? Lighting::raw : Lighting::lit;
  options.albedo_mix = random.coin() ? 0 : random.uniform(0, 1);
  return options;
}

}  // namespace dermis::oracle
