/// Taps for every size of kernel, as the passes and the oracle read them. Callers of the filter need none of it.
#pragma once

#include <array>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/taps.hpp"

namespace dermis {

/// A function of distance for three channels that a kernel evaluates from the squared distance without a root, a
/// logarithm or a look-up in memory: a parabola in each of 32 octaves of r^4,
///
///     value = a + t (b + t c),   r^4 = 2^(first_exponent + octave) (1 + t),   0 <= t < 1.
///
/// It has no jumps. Below the first octave it is the first value, beyond the last octave the last (0 for a falloff).
struct RadialTable {
  static constexpr int octaves = 32;

  int first_exponent = 0;
  std::array<std::array<std::array<float, octaves>, 3>, 3> coefficients{};  ///< a, b, c of each channel
};

/// One term of the separable passes: scale f(x) f(y).
struct Term {
  std::array<float, 3> scale{1, 1, 1};
  /// True: the result is sum w_i x_i / sum w_i over the taps of the pixel's material. False: the term is a difference
  /// from the pixel itself, sum x_0 + g sum w_i (x_i - x_0), so that a missing tap counts as the pixel, with g = 1 /
  /// max(1, sum of w_i of the first term).
  bool normalised = true;
  std::array<float, 3> sum{1, 1, 1};  ///< sum of the weights where no tap is missing; 1 if normalised
  RadialTable falloff;                ///< f(r), 1/mm
  RadialTable centre;                 ///< integral of f over |x| < h, tabulated over sqrt(h) for resolution near 0
};

/// Weight of one pair of taps in one term, on a surface of any form:
///
///     w = length_mm px_per_mm s falloff(distance / k) / k + share w(first term)
///
/// with the px_per_mm of the level, s the mm of surface that the pixel spans along the pass, and k its width factor.
struct TapWeight {
  std::array<float, 3> length_mm;
  std::array<float, 3> share;  ///< 0 in the first term
};

/// The taps for kernels of about one size in pixels. Weights are listed tap by tap, each tap with all its terms: the
/// centre first where it has a weight, then the pairs by ascending offset.
struct TapLevel {
  float px_per_mm;                                ///< pixels per mm that the taps were placed for
  float centre_half_width_px;                     ///< the centre tap stands for |x| < this
  std::vector<std::array<float, 3>> centre_gain;  ///< per term: w_0 = centre_gain centre(centre_half_width_px s / k)
  std::vector<int> offsets_px;                    ///< one pair of taps each, at + and - the offset; ascending, > 0
  std::vector<TapWeight> weights;                 ///< of the pairs
  /// Weights of the centre and of the pairs on a flat block, for the kernel radius nearest to each eighth of the level.
  /// They are multiples of 2^-24; of a normalised term they sum to exactly 1, and of no other is the centre's used.
  std::array<std::vector<std::array<float, 3>>, 8> flat_weights;
  /// Change of the flat weights of the level's middle (the fifth eighth) on a smooth block, per unit of the stretch q:
  /// of the centre and the pairs. They are multiples of 2^-20 that sum to exactly 0 in every term.
  std::vector<std::array<float, 3>> stretch_weights;
  /// The change per unit of the skew k, of the pairs: of the tap at +, while the tap at - changes by the opposite.
  std::vector<std::array<float, 3>> skew_weights;
};

/// A profile as the separable passes read it: a level table of tap sets over kernel size, so that every tap lies on a
/// whole pixel at any size of a pixel, and f of each term with its integral as tables, so that a pass can weigh each
/// tap by the true distance of the surface points. METHODS.md, "The separable passes", says what the passes make of it:
/// which level a block of 16 x 16 pixels takes, its class (flat, smooth or curved), the shear of the vertical pass, and
/// the weights in each class.
struct Taps {
  /// The radius, mm, beyond which the passes do not look: 99.9 % of the widest channel's marginal lie within for rank
  /// 1, 99.99 % for rank 2, 99.999 % for more.
  double radius_mm = 0;
  /// The same radius of each channel's own marginal, divided by radius_mm: 1 for the widest channel.
  std::array<float, 3> relative_width{};
  std::vector<Term> terms;       ///< the first is normalised
  std::vector<TapLevel> levels;  ///< see level_index

  /// With T the change of position per pixel along a pass and dT how far it varies within reach of the taps, a block is
  /// flat if |dT| <= flatness |T|, and smooth if |dT| <= smoothness |T|.
  static constexpr float flatness = 0.1F;
  static constexpr float smoothness = 0.4F;

  /// Bounds of the stretch q = px_per_mm^2 |T|^2 - 1, and of the skew k = px_per_mm^2 T.T' times the offset of the
  /// farthest tap, where T is that of the pixel, and T' its change per pixel.
  static constexpr float most_stretch = 0.75F;
  static constexpr float most_skew = 0.5F;

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
