// One column of the frame for the vectorised filter. This header is built once per instruction set, so it uses no
// inline function of the standard library: the linker would keep one copy of it for all.
#pragma once

#include <cstddef>

namespace dermis::bench {

/// Strips are this wide; both passes of one stay in a second-level cache.
inline constexpr int strip_width_px = 64;

/// Depths from here on are background, and stand for what is of another material.
inline constexpr float background_from = 1e9F;

/// A strip of one material and what to filter it with. Planes have room for the largest offset left and right of the
/// frame, and for a whole strip. With depth, what is background keeps what was in `scattered`.
struct Strip {
  const float* light[3];
  const float* depth;
  float* scattered[3];
  std::ptrdiff_t pitch;  ///< floats from row to row of all planes
  int first_column;
  int height;
  const int* offsets_px;  ///< > 0, ascending; a pair of taps each
  const float* weights;   ///< three per pair
  int pairs;
  float centre_weight[3];
  float falloff;  ///< a tap weighs max(0, 1 - falloff dz^2)
  float* ring;    ///< 3 ring_rows strip_width_px floats: rows after the horizontal pass
  int ring_rows;  ///< a power of two, more than twice the largest offset
};

void filter_strip_avx512(const Strip& strip, bool with_depth);
void filter_strip_avx2(const Strip& strip, bool with_depth);
void filter_strip_plain(const Strip& strip, bool with_depth);

namespace {

template <int lanes>
struct Vectors {
  typedef float Type __attribute__((vector_size(lanes * sizeof(float))));
  typedef float Loose __attribute__((vector_size(lanes * sizeof(float)), aligned(4), may_alias));
};

template <int lanes>
inline auto load(const float* from) {
  return static_cast<typename Vectors<lanes>::Type>(*reinterpret_cast<const typename Vectors<lanes>::Loose*>(from));
}

template <int lanes>
inline void store(float* to, typename Vectors<lanes>::Type value) {
  *reinterpret_cast<typename Vectors<lanes>::Loose*>(to) = value;
}

/// The weighted sum at some pixels of a row and, with depth, the weights'.
template <int lanes, bool with_depth>
struct Sums {
  using V = typename Vectors<lanes>::Type;

  V sum[3], weight[3], depth{};

  Sums(const Strip& strip, const float* const light[3], std::ptrdiff_t at, const float* its_depth) {
    for (int c = 0; c < 3; ++c) {
      weight[c] = V{} + strip.centre_weight[c];
      sum[c] = weight[c] * load<lanes>(light[c] + at);
    }
    if constexpr (with_depth) depth = load<lanes>(its_depth);
  }

  V share(const Strip& strip, const float* tap_depth) const {
    const V difference = load<lanes>(tap_depth) - depth;
    const V share = 1 - strip.falloff * difference * difference;
    const V none{};
    return share > none ? share : none;
  }

  /// A pair of taps. An end outside the frame is left out.
  void add(const Strip& strip, int pair, const float* const light[3], std::ptrdiff_t before, std::ptrdiff_t after,
           const float* depth_before, const float* depth_after, bool has_before, bool has_after) {
    const V none{};
    V share_before = none + (has_before ? 1.0F : 0.0F);
    V share_after = none + (has_after ? 1.0F : 0.0F);
    if constexpr (with_depth) {
      if (has_before) share_before = share(strip, depth_before);
      if (has_after) share_after = share(strip, depth_after);
    }
    for (int c = 0; c < 3; ++c) {
      const float w = strip.weights[3 * pair + c];
      const V a = load<lanes>(light[c] + before);
      const V b = load<lanes>(light[c] + after);
      if constexpr (with_depth) {
        sum[c] += w * (share_before * a + share_after * b);
        weight[c] += w * (share_before + share_after);
      } else {
        sum[c] += w * (a + b);
      }
    }
  }

  V result(int c) const { return with_depth ? sum[c] / weight[c] : sum[c]; }

  /// The result, or what was there before where it is background.
  V result_over(int c, const float* before) const {
    const V limit = V{} + background_from;
    return !with_depth ? result(c) : depth < limit ? result(c) : load<lanes>(before);
  }
};

template <int lanes, bool with_depth>
inline void pass_along_x(const Strip& strip, int y) {
  for (int x = 0; x < strip_width_px; x += lanes) {
    const std::ptrdiff_t at = y * strip.pitch + strip.first_column + x;
    Sums<lanes, with_depth> sums(strip, strip.light, at, strip.depth + at);
    for (int i = 0; i < strip.pairs; ++i) {
      const int offset = strip.offsets_px[i];
      sums.add(strip, i, strip.light, at - offset, at + offset, strip.depth + at - offset, strip.depth + at + offset,
               true, true);
    }
    float* row = strip.ring + 3 * static_cast<std::ptrdiff_t>(y & (strip.ring_rows - 1)) * strip_width_px + x;
    for (int c = 0; c < 3; ++c) store<lanes>(row + c * strip_width_px, sums.result(c));
  }
}

template <int lanes, bool with_depth>
inline void pass_along_y(const Strip& strip, int y) {
  const float* const ring[3] = {strip.ring, strip.ring + strip_width_px, strip.ring + 2 * strip_width_px};
  const auto row = [&](int at) { return 3 * static_cast<std::ptrdiff_t>(at & (strip.ring_rows - 1)) * strip_width_px; };
  for (int x = 0; x < strip_width_px; x += lanes) {
    const std::ptrdiff_t at = y * strip.pitch + strip.first_column + x;
    Sums<lanes, with_depth> sums(strip, ring, row(y) + x, strip.depth + at);
    for (int i = 0; i < strip.pairs; ++i) {
      const int offset = strip.offsets_px[i];
      // Without depth there is no division by the weights, and the edge row stands for those outside.
      const bool has_before = y - offset >= 0;
      const bool has_after = y + offset < strip.height;
      const int before = has_before ? y - offset : 0;
      const int after = has_after ? y + offset : strip.height - 1;
      const std::ptrdiff_t column = strip.first_column + x;
      sums.add(strip, i, ring, row(before) + x, row(after) + x, strip.depth + before * strip.pitch + column,
               strip.depth + after * strip.pitch + column, has_before, has_after);
    }
    for (int c = 0; c < 3; ++c) {
      float* const to = strip.scattered[c] + at;
      store<lanes>(to, sums.result_over(c, to));
    }
  }
}

/// The vertical pass follows the horizontal one by as many rows as it looks ahead.
template <int lanes, bool with_depth>
inline void filter_strip(const Strip& strip) {
  const int reach = strip.pairs > 0 ? strip.offsets_px[strip.pairs - 1] : 0;
  for (int y = 0; y < strip.height + reach; ++y) {
    if (y < strip.height) pass_along_x<lanes, with_depth>(strip, y);
    if (y >= reach) pass_along_y<lanes, with_depth>(strip, y - reach);
  }
}

template <int lanes>
inline void filter_strip(const Strip& strip, bool with_depth) {
  with_depth ? filter_strip<lanes, true>(strip) : filter_strip<lanes, false>(strip);
}

}  // namespace

}  // namespace dermis::bench
