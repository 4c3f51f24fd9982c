/// A profile made discrete: which pixels the separable passes read, and what each is worth.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dermis/names.hpp"
#include "dermis/profile.hpp"

namespace dermis {

/// How few one-dimensional functions stand for the profile: R(sqrt(x^2 + y^2)) ~ sum over terms of scale f(x) f(y).
enum class Model {
  pre_integrated,  ///< rank 1: the marginal a(x) (Jimenez et al. 2015, eq. 4-5); exact along axis-parallel edges
  artist,          ///< rank 1: two Gaussians fitted to a(x) (eq. 6)
  guided,          ///< rank 1: near or far scattering emphasised by `guide` (Appendix A)
  svd,             ///< rank 1..6: truncated singular value decomposition, scaled to keep all light
  gaussians,       ///< rank 1..6: so many Gaussians fitted to the profile (d'Eon and Luebke 2007)
  optimised,       ///< rank 1: least error on natural images; rank 2, 3: a(x) and zero-sum corrections to it
};

template <>
inline constexpr std::array<Named<Model>, 6> names<Model> = {{{Model::pre_integrated, "pre-integrated"},
                                                              {Model::artist, "artist"},
                                                              {Model::guided, "guided"},
                                                              {Model::svd, "svd"},
                                                              {Model::gaussians, "gaussians"},
                                                              {Model::optimised, "optimised"}}};

/// Where the taps of a pass lie.
enum class Placement {
  uniform,     ///< at equal distances
  importance,  ///< each stands for the same light of the widest channel (Jimenez et al. 2015, section 6)
  quadratic,   ///< distances grow with the square of the number, as the 2012 shader has them
  optimised,   ///< positions and weights together make the error on natural images least; as importance beyond 65 taps
};

template <>
inline constexpr std::array<Named<Placement>, 4> names<Placement> = {{{Placement::uniform, "uniform"},
                                                                      {Placement::importance, "importance"},
                                                                      {Placement::quadratic, "quadratic"},
                                                                      {Placement::optimised, "optimised"}}};

/// How a pass reads between pixels.
enum class Fetch {
  integer,  ///< at whole pixels only
  linear,   ///< anywhere, by linear interpolation of two neighbours
};

template <>
inline constexpr std::array<Named<Fetch>, 2> names<Fetch> = {{{Fetch::integer, "integer"}, {Fetch::linear, "linear"}}};

/// How far taps may be off at most, as TapSet::predicted_rel_l2.
enum class Quality {
  draft,      ///< 5 %
  preview,    ///< 2 %
  final,      ///< 0.6 %
  reference,  ///< not at all: the exact method, which takes some hundred times as long
};

template <>
inline constexpr std::array<Named<Quality>, 4> names<Quality> = {{{Quality::draft, "draft"},
                                                                  {Quality::preview, "preview"},
                                                                  {Quality::final, "final"},
                                                                  {Quality::reference, "reference"}}};

/// The error that a quality allows, as a share of the light: 0.05, 0.02, 0.006, or 0 for the reference.
double tolerance_of(Quality quality);

/// What taps to make of a profile.
struct TapsDesign {
  Model model = Model::optimised;
  /// Terms: 1 for most models, 1..6 for svd and gaussians, 1..3 for optimised. 0, with a tolerance: see with_rank.
  int rank = 1;
  int count = 17;  ///< taps per pass, centre included: odd, 3..2047; the most of them if there is a tolerance
  Placement placement = Placement::optimised;
  bool non_negative = false;  ///< optimised, rank 2 and 3: hold the approximated profile above zero, for a little error
  double guide = 2;           ///< guided: k in 0..4, sharper to smoother
  /// An error to be content with, as TapSet::predicted_rel_l2, below 1: each width of kernel gets no more taps than
  /// that takes, of 5, 7, 11, 17, 25, 33, 49, 65 and `count`. Where no count will do, because the model itself is
  /// further off, they are as many as bring the error to 5/4 of the model's. 0: all widths get `count`.
  double tolerance = 0;
  /// Kernels of a larger radius, px, have the taps of one half as wide, or a quarter, and so on, which are placed for
  /// the finer kernel; unless `count` is as large. Each halving makes the level table in less than half the
  /// time: 64..512.
  int widest_px = 512;

  bool operator==(const TapsDesign&) const = default;
};

/// One term of a TapSet.
struct TapTerm {
  Rgb scale{};                                ///< the term is scale w(x) w(y)
  std::vector<std::array<float, 3>> weights;  ///< per offset and channel
};

/// Taps for pixels of one size on a surface parallel to the screen: channel c of the kernel is the sum over terms of
/// scale_c times w_c (x) w_c.
struct TapSet {
  double pixel_mm = 0;  ///< size of a pixel on the surface
  Fetch fetch = Fetch::integer;
  std::vector<double> offsets_px;  ///< ascending and symmetric; whole unless the fetch is linear
  /// The weights are multiples of 2^-24. Those of the first term sum to exactly 1 in every channel, in float32 in any
  /// order (those of all terms if the model is gaussians); those of an optimised model's corrections to exactly 0.
  std::vector<TapTerm> terms;
  /// Expected relative L2 distance, all channels together, from the exact convolution with the profile, over images
  /// with a 1/f amplitude spectrum.
  double predicted_rel_l2 = 0;
};

/// The terms that a model can have at most.
int highest_rank(Model model);

/// The design with a rank in place of 0: the lowest whose model alone is off by at most 3/4 of the tolerance, which
/// leaves the rest to the taps; the highest if there is none. `pixel_mm` is the size of a pixel that this is to
/// hold for; 0: the kernel has a radius of 64 of them. Throws Error(usage) if the design is out of range, or `pixel_mm`
/// neither 0 nor in 1e-12..1e12.
TapsDesign with_rank(const Profile& profile, const TapsDesign& design, double pixel_mm = 0);

/// The design with its rank and its taps left to a tolerance above 0: rank 0, and at most 33 taps, for with more of
/// them fits are slow. choose_design allows more where they are needed.
TapsDesign design_within(double tolerance, TapsDesign design = {});

/// A design for pixels of one size, and the predicted error of the fewest of its taps that will do there.
struct DesignChoice {
  TapsDesign design;
  double predicted_rel_l2 = 0;
};

/// The first design that meets the tolerance of `wanted` for pixels of that size, or the best one if none does: of
/// `wanted.count` taps and one rank after the other, from that of with_rank on, then of 65 taps and the highest rank. A
/// rank that `wanted` has stays. A profile whose width follows albedo or mask is taken at its widest, where the error
/// is largest. Throws Error(usage) if the design is out of range or has no tolerance, or `pixel_mm` is not in
/// 1e-12..1e12.
DesignChoice choose_design(const Profile& profile, const TapsDesign& wanted, double pixel_mm);

/// Taps for one pixel size; of the fewest taps that meet the tolerance, if the design has one. Throws Error(usage) if
/// the design is out of range, or `pixel_mm` not in 1e-12..1e12.
TapSet make_tap_set(const Profile& profile, const TapsDesign& design, double pixel_mm, Fetch fetch = Fetch::integer);

/// The design with the fewest reads per pixel, (1 + rank) count, whose taps at whole pixels have a predicted error of
/// at most `tolerance` for pixels of that size; none if only the exact method can do. Throws Error(usage) if
/// `tolerance` is not above 0 or `pixel_mm` not in 1e-12..1e12.
std::optional<TapsDesign> cheapest_design(const Profile& profile, double tolerance, double pixel_mm);

/// A function of distance for three channels that a kernel evaluates from the squared distance without a root, a
/// logarithm or a look-up in memory: a parabola in each of 32 octaves of r^4,
///
///     value = a + t (b + t c),   r^4 = 2^(first_exponent + octave) (1 + t),   0 <= t < 1.
///
/// It has no jumps. Below the first octave it is the first value, beyond the last octave the last (0 for a falloff).
struct RadialTable {
  static constexpr int octaves = 32;

  int first_exponent = 0;
  std::array<std::array<std::array<float, octaves>, 3>, 3> coefficients{};  ///< of each channel: a, b, c
};

/// One term of the separable passes: scale f(x) f(y).
struct Term {
  std::array<float, 3> scale{1, 1, 1};
  /// True: the weighted sum is divided by the sum of its weights. False: the term is a difference from the pixel
  /// itself, sum x_0 + sum over taps of w_i (x_i - x_0), so that missing taps count as the pixel.
  bool normalised = true;
  std::array<float, 3> sum{1, 1, 1};  ///< of the weights, where nothing is missing; 1 if normalised
  RadialTable falloff;                ///< f(r), 1/mm
  RadialTable centre;                 ///< integral of f over |x| < r^2: of the root of a distance, to reach nearer to 0
};

/// What one pair of taps is worth in one term.
struct TapWeight {
  std::array<float, 3> length_mm;  ///< times f(distance)
  std::array<float, 3> share;      ///< times the pair's weight in the first term; 0 in the first term
};

/// The taps for kernels of about one size in pixels.
struct TapLevel {
  float px_per_mm;                                ///< pixels per mm that the taps were placed for
  float centre_half_width_px;                     ///< the centre tap stands for |x| < this
  std::vector<std::array<float, 3>> centre_gain;  ///< per term: times the centre's light
  std::vector<int> offsets_px;                    ///< one symmetric pair of taps each, at + and -; ascending, > 0
  std::vector<TapWeight> weights;                 ///< of all terms of the first pair, then of the second, ...
  /// What a tap is worth on a flat block, for kernel radii nearest to each eighth of the level: of all terms of the
  /// centre, then of the first pair, ... Multiples of 2^-24; of a normalised term they sum to exactly 1. The centre's
  /// is used if the term is normalised.
  std::array<std::vector<std::array<float, 3>>, 8> flat_weights;
  /// What the flat weights of the level's middle (the fifth eighth) change by on a smooth block: with the stretch q, of
  /// all terms of the centre, then of the first pair, ... Multiples of 2^-20, which sum to exactly 0 in every term; and
  /// with the skew k, of all terms of the first pair, ..., for the tap at + of a pair, the other one changing by the
  /// opposite.
  std::vector<std::array<float, 3>> stretch_weights;
  std::vector<std::array<float, 3>> skew_weights;
};

/// What the separable passes need to know of a profile: a level table of tap sets over kernel size, so that
/// every tap lies on a whole pixel whatever the px_per_mm, and each term's f and its integral as tables, so that a pass
/// can weigh each tap by the true distance of the surface points.
///
/// A pass over pixel p of width factor k per channel (1 unless an albedo or mask scales the profile) takes the level of
/// its block and computes for each term t
///
///     w_0 = centre_gain centre(sqrt(centre_half_width_px s_p / k))
///     w_i = length_mm_i level.px_per_mm s_i falloff(|P_p - P_i| / k) / k + share_i w_i(first term)
///     result = sum w_i x_i / sum w_i                      if t is normalised
///            = sum_t x_p + g sum w_i (x_i - x_p)          if not, g = 1 / max(1, sum w_i(first term))
///
/// where P are the surface points and s is the length of surface, mm, that a pixel spans along the pass. The sums go
/// over the taps that lie on the same material. The horizontal pass makes one image per term from the light, the
/// vertical pass the sum over terms of scale times its result on that image.
///
/// Let X and Y be the change of position with one pixel along x and along y, the change of depth in it being the
/// smaller one of the differences to both neighbours of the same material, 0 if they differ in sign. The horizontal
/// pass runs along (1, 0), with s = |X|. The vertical one runs along (shear, 1),
///
///     shear = - X.Y / X.X, held within -1..1      s = |Y + shear X|
///
/// so that on the surface it crosses the horizontal one at a right angle (Gram and Schmidt): on the screen a surface
/// that is tilted both ways shows its axes askew. The tap of offset o lies o rows below and floor(o shear + 1/2)
/// columns to the side, held within -32..32, shear rounded to 1/4096. Shear is 0 without depth, with rotated taps, and
/// without Options::sheared.
///
/// A block is 16 x 16 pixels, its corner at a multiple of 16. Its level in a pass is that of the kernel radius
/// radius_mm * max over its pixels that scatter of F max_c(k_c relative_width_c), where F is the pixel's px_per_mm
/// along the pass; if that level is -1 each term is its sum at one point.
///
/// On a flat block the weights are those of the level: w_i = flat_weights_i, whatever the depth; and its level in a
/// pass along x, and the eighth of the level, is the nearest to the kernel radius radius_mm / |T|, as the surface is
/// seen at an angle. A block is flat in a pass if no pixel has a width of its own and no tap is rotated, and if there
/// is no depth, or the surface within reach is nearly a plane. Reach is 9/8 of the farthest tap, for the radius above,
/// of the materials that scatter in the block. Of the pixels with a material in the blocks of the same row (column, for
/// the vertical pass) that lie at least partly within reach, let z be the depths and g, h the differences between the
/// depths of neighbours of the same material within a block, in x and in y; with their middles z', g', h' and half
/// ranges dz, dg, dh (0 where there is no pair), and x', y' = change of position with depth along the ray through the
/// middle of the block,
///
///     T  = (size(z') + x' g', y' g', g')                change of position per pixel
///     dT = (size(dz) + |x'| dg, |y'| dg, dg)            how much it may vary; size(dz) = dz / focal length
///     flat if |dT|^2 <= flatness^2 |T|^2
///         and 2 dz <= columns (|g'| + dg) + rows (|h'| + dh) + |T|   no step, columns and rows counting the pixels of
///                                                       those blocks that lie in the frame
///
/// and the same with x and y exchanged. In the vertical pass all pixels of a flat block share the shear in its middle,
/// of the z', g' and h' of its own pixels; the blocks beside those in the column that the taps reach are looked at too,
/// and T and dT are those along (shear, 1): T + shear times the other T, dT + |shear| times the other dT. A shear that
/// moves no tap within reach is 0. A block is smooth in a pass if it is not flat, but would be with `smoothness` in
/// place of `flatness`. Its level is the nearest to the same kernel radius, and the weights are, to first order, those
/// of the true distances along a surface that bends:
///
///     w_i = flat_weights_i + q stretch_weights_i +- k skew_weights_i
///     q = level.px_per_mm^2 |T|^2 - 1,  k = level.px_per_mm^2 T.T'    both held within -most_stretch..most_stretch and
///                                                                 -most_skew / last offset..most_skew / last offset
///
/// where T is the pixel's own change of position along the pass, with the block's shear, and T' that of T, both by
/// central differences of depth (of the difference to the only neighbour of the same material if the other one is of
/// another; 0 if there is none); the mixed second difference is that of the pixels on the diagonal, 0 unless both are
/// of the material.
struct Taps {
  /// The radius, mm, beyond which the passes do not look: 99.9 % of the widest channel's marginal lie within for rank
  /// 1, 99.99 % for rank 2, 99.999 % for more.
  double radius_mm = 0;
  /// The same radius of each channel's own marginal, divided by radius_mm: 1 for the widest channel.
  std::array<float, 3> relative_width{};
  std::vector<Term> terms;       ///< the first is normalised
  std::vector<TapLevel> levels;  ///< see level_index

  /// How much of its length the change of position per pixel may vary within reach on a flat block, and on a smooth
  /// one.
  static constexpr float flatness = 0.1F;
  static constexpr float smoothness = 0.4F;

  /// Bounds of q, and of k times the farthest tap's offset.
  static constexpr float most_stretch = 0.75F;
  static constexpr float most_skew = 0.5F;

  /// Kernel radii of the first and the last level, px: narrower kernels are left alone, wider ones use the last level.
  /// A channel whose own radius on a level is below the first has no weights there but its centre's.
  static constexpr float min_radius_px = 0.5F;
  static constexpr int log2_levels_per_octave = 4;
  static constexpr int octaves = 15;

  /// The level for a kernel radius in px, or -1 if the kernel is narrower than half a pixel.
  /// Levels divide each octave in 16 equal steps.
  static int level_index(float radius_px);
};

/// The level table of a design. Throws Error(usage) if the design is out of range.
Taps make_taps(const Profile& profile, const TapsDesign& design);

}  // namespace dermis
