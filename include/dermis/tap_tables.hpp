/// Taps for every size of kernel, as the passes and the oracle read them. Callers of the filter need none of it.
#pragma once

#include <array>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/taps.hpp"

namespace dermis {

/// One term of the separable passes: scale f(x) f(y).
struct Term {
  std::array<float, 3> scale{1, 1, 1};
  /// True: the result is sum w_i x_i / sum w_i over the taps of the pixel's material. False: the term is a difference
  /// from the pixel itself, sum x_0 + g sum w_i (x_i - x_0), so that a missing tap counts as the pixel, with g = 1 /
  /// max(1, sum of w_i of the first term).
  bool normalised = true;
  std::array<float, 3> sum{1, 1, 1};  ///< sum of the weights where no tap is missing; 1 if normalised
};

/// How near a point of the surface is to a pixel, t = max(scale / (a + softening) - end, 0), where t = 1 at the
/// distance at which the plane of the level has the tap. For a pair of taps a is (d / k)^2, mm^2, of the true distance
/// d and the pixel's width factor k, and t is 0 from twice the radius of the kernel on; for the centre a is s / k, mm,
/// of the length of surface s that the pixel spans along the pass, and the end is 0.
struct Nearness {
  float scale;
  float softening;  ///< above 0
  float end;
};

/// Coefficients (A, B, C) of three channels. A pair of taps weighs
///
///     w = (s / k) t (A + t (B + t C))
///
/// on a curved block, with the s of the pixel that it falls on, and the centre of a normalised term
///
///     w_0 = max(1 - t (A + t (B + t C)), least_centre_weight).
///
/// A is in 1/mm for a pair and a number for the centre, and so are B and C.
using CubicWeight = std::array<std::array<float, 3>, 3>;  ///< [A, B, C][channel]

/// No centre weighs less, so that a pixel without any other tap keeps its light.
inline constexpr float least_centre_weight = 0x1p-20F;

/// The taps for kernels of about one size in pixels. Weights are listed tap by tap, each tap with all its terms: the
/// centre first, then the pairs by ascending offset.
struct TapLevel {
  float px_per_mm;                   ///< pixels per mm that the taps were placed for
  std::vector<int> offsets_px;       ///< one pair of taps each, at + and - the offset; ascending, > 0
  std::vector<Nearness> nearness;    ///< of the centre, then of the pairs
  std::vector<CubicWeight> weights;  ///< on a curved block; 0 for the centre of a term that is not normalised
  /// Weights on a flat block, for the kernel radius nearest to each eighth of the level. They are multiples of 2^-24;
  /// of a normalised term they sum to exactly 1, and of no other is the centre's used.
  std::array<std::vector<std::array<float, 3>>, 8> flat_weights;
};

/// A profile as the separable passes read it: a level table of tap sets over kernel size, so that every tap lies on a
/// whole pixel at any size of a pixel, with weights on a plane and by the true distance of surface points. METHODS.md,
/// "The separable passes", says what the passes make of it: which level a block of 16 x 16 pixels takes, its class
/// (flat or curved), the shear of the vertical pass, and the weights in each class.
struct Taps {
  /// The radius, mm, beyond which the passes do not look: 99.9 % of the widest channel's marginal lie within for rank
  /// 1, 99.99 % for rank 2, 99.999 % for more.
  double radius_mm = 0;
  /// The same radius of each channel's own marginal, divided by radius_mm: 1 for the widest channel.
  std::array<float, 3> relative_width{};
  std::vector<Term> terms;       ///< the first is normalised
  std::vector<TapLevel> levels;  ///< see level_index

  /// With T the change of position per pixel along a pass and dT how far it varies within reach of the taps, a block is
  /// flat if |dT| <= flatness |T|.
  static constexpr float flatness = 0.2F;

  /// Kernel radii of the first and the last level, px: narrower kernels are left alone, wider ones use the last level.
  /// A channel whose own radius on a level is below the first has no weights there but its centre's.
  static constexpr float min_radius_px = 0.5F;
  static constexpr int log2_levels_per_octave = 4;
  static constexpr int octaves = 15;

  /// The level for a kernel radius in px, or -1 if the kernel is narrower than half a pixel. Levels divide each octave
  /// in 16 equal steps.
  static int level_index(float radius_px);
};

/// The level table of a design. Throws Error(usage) if the design is out of range.
Taps make_taps(const Profile& profile, const TapsDesign& design);

}  // namespace dermis
