/// Taps: a profile made discrete, as the pixels that the separable passes read and the weight of each.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dermis/profile.hpp"
#include "dermis/words.hpp"

namespace dermis {

/// A way to make a profile of a few one-dimensional functions: R(sqrt(x^2 + y^2)) ~ sum over terms of scale f(x) f(y).
enum class Model {
  pre_integrated,  ///< rank 1: the marginal a(x) (Jimenez et al. 2015, eq. 4-5); exact along axis-parallel edges
  artist,          ///< rank 1: two Gaussians fitted to a(x) (eq. 6)
  guided,          ///< rank 1: near or far scattering emphasised by `guide` (Appendix A)
  svd,             ///< rank 1..6: truncated singular value decomposition, scaled to keep all light
  gaussians,       ///< rank 1..6: so many Gaussians fitted to the profile (d'Eon and Luebke 2007)
  optimised,       ///< rank 1: least error on natural images; rank 2, 3: a(x) and zero-sum corrections to it
};

template <>
inline constexpr std::array<Named<Model>, 6> word_table<Model> = {{{Model::pre_integrated, "pre-integrated"},
                                                                   {Model::artist, "artist"},
                                                                   {Model::guided, "guided"},
                                                                   {Model::svd, "svd"},
                                                                   {Model::gaussians, "gaussians"},
                                                                   {Model::optimised, "optimised"}}};

/// A way to place the taps of a pass.
enum class Placement {
  uniform,     ///< at equal distances
  importance,  ///< each stands for the same light of the widest channel (Jimenez et al. 2015, section 6)
  quadratic,   ///< distances grow with the square of the number, as the 2012 shader has them
  optimised,   ///< positions and weights together make the error on natural images least; as importance beyond 65 taps
};

template <>
inline constexpr std::array<Named<Placement>, 4> word_table<Placement> = {{{Placement::uniform, "uniform"},
                                                                           {Placement::importance, "importance"},
                                                                           {Placement::quadratic, "quadratic"},
                                                                           {Placement::optimised, "optimised"}}};

/// The points that a pass can read.
enum class Fetch {
  integer,  ///< at whole pixels only
  linear,   ///< anywhere, by linear interpolation of two neighbours
};

template <>
inline constexpr std::array<Named<Fetch>, 2> word_table<Fetch> = {
    {{Fetch::integer, "integer"}, {Fetch::linear, "linear"}}};

/// How far taps may be off at most, as TapSet::predicted_rel_l2.
enum class Quality {
  draft,      ///< 5 %
  preview,    ///< 2 %
  final,      ///< 0.6 %
  reference,  ///< not at all: the exact method, which takes some hundred times as long
};

template <>
inline constexpr std::array<Named<Quality>, 4> word_table<Quality> = {{{Quality::draft, "draft"},
                                                                       {Quality::preview, "preview"},
                                                                       {Quality::final, "final"},
                                                                       {Quality::reference, "reference"}}};

/// The error that a quality allows, as a share of the light: 0.05, 0.02, 0.006, or 0 for the reference.
double tolerance_of(Quality quality);

/// A choice of taps for a profile.
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

}  // namespace dermis
