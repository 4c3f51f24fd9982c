/// A profile made discrete: which pixels a separable pass reads, and what each is worth.
#pragma once

#include <array>
#include <vector>

#include "dermis/profile.hpp"

namespace dermis {

/// A function of distance, tabulated for three channels so that a kernel can evaluate it from the
/// squared distance without a root or a logarithm: nodes sit at r^2 = 2^e (1 + m / M) for the integers
/// e >= first_exponent and 0 <= m < M = 2^log2_nodes_per_octave, which is where the exponent and top
/// mantissa bits of a float32 change. Between nodes the value is linear in r^2; below the first node it is
/// the first value; from the last node on it is the last value (which is 0 for a falloff).
struct RadialTable {
  int first_exponent = 0;
  int log2_nodes_per_octave = 0;
  std::vector<std::array<float, 3>> values;
};

/// One symmetric pair of taps, at +offset_px and -offset_px from the pixel.
struct TapPair {
  int offset_px;                   ///< > 0
  std::array<float, 3> length_mm;  ///< the tap's weight is length_mm * a(distance); per channel
};

/// The taps for kernels of about one size in pixels.
struct Rung {
  float footprint;             ///< pixels per mm that the taps were placed for
  float core_half_width_px;    ///< the centre tap stands for |x| < this; its weight is core(that / footprint)
  std::vector<TapPair> pairs;  ///< by ascending offset
};

/// What the separable passes need to know of a profile: a ladder of tap sets over kernel size, so that
/// every tap lies on a whole pixel whatever the footprint, and the profile's marginal a(x) and its integral as
/// tables, so that a pass can weigh each tap by the true distance of the surface points.
///
/// A pass over pixel p of width factor k per channel (1 unless an albedo or mask scales the profile) takes the rung of
/// its span and computes
///
///     w_0 = core(core_half_width_px s_p / k)
///     w_i = length_mm_i rung.footprint s_i falloff(|P_p - P_i| / k) / k
///     result = sum w_i x_i / sum w_i
///
/// where P are the surface points and s is the length of surface, mm, that a pixel spans along the pass: |dP/dx| or
/// |dP/dy|, the change of depth in it being the smaller one of the differences to both neighbours of the same material,
/// 0 if they differ in sign. The sums go over the taps that lie on the same material. The rung of a pass is that of the
/// kernel radius radius_mm * max over the pixels of a span that scatter of F max_c(k_c relative_width_c), where F is
/// the pixel's footprint and a span is 16 pixels of a row, starting at a multiple of 16; a pass whose rung is -1
/// changes nothing. On a plane parallel to the screen w_i is the light that falls on the run of pixels the tap stands
/// for, to first order in the step between rungs.
struct Taps {
  /// The radius, mm, beyond which the passes do not look: 99.9 % of the widest channel's marginal.
  double radius_mm = 0;
  /// The same radius of each channel's own marginal, divided by radius_mm: 1 for the widest channel.
  std::array<float, 3> relative_width{};
  RadialTable falloff;      ///< a(r), 1/mm
  RadialTable core;         ///< share of the light within |x| < r
  std::vector<Rung> rungs;  ///< see rung_index

  /// Kernel radii of the first and the last rung, px: narrower kernels are left alone, wider ones use the last rung.
  static constexpr float min_radius_px = 0.5F;
  static constexpr int log2_rungs_per_octave = 4;
  static constexpr int octaves = 15;

  /// The rung for a kernel radius in px, or -1 if the kernel is narrower than half a pixel.
  /// Rungs divide each octave in 16 equal steps.
  static int rung_index(float radius_px);

  /// Importance-sampled taps from the pre-integrated profile (Jimenez et al. 2015, section 6): every tap
  /// stands for a run of whole pixels; runs hold equal shares of the widest channel's light, except that none
  /// is narrower than a pixel. `count` is the number of taps per pass, centre included: odd, 3..127.
  /// Throws Error(usage) otherwise.
  static Taps importance_sampled(const Profile& profile, int count);
};

}  // namespace dermis
