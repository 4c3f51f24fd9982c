/// The filter in plain scalar double precision, to check the kernels against. It shares no code with them.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/oracle/picture.hpp"
#include "dermis/plan.hpp"
#include "dermis/profile.hpp"
#include "dermis/tap_tables.hpp"

namespace dermis::oracle {

/// The medium of a random walk, per channel.
struct WalkMedium {
  std::array<double, 3> mfp_mm;
  std::array<double, 3> scattering_albedo;  ///< what a scattering leaves
};

/// A material, as the oracle needs it. Only surface_integral, disc and hidden_light use `radial` and `cdf`; of `taps`
/// they use only the radii, to find the kernels that are narrower than half a pixel.
struct Material {
  int id = 0;
  std::optional<AlbedoWidth> albedo_width;  ///< Profile::albedo_width
  Taps taps;
  std::function<double(int channel, double r_mm)> radial;  ///< R(r), 1/mm^2
  std::function<double(int channel, double r_mm)> cdf;     ///< share of the light within r, 0..1
  bool is_projected = false;                               ///< Profile::is_projected
  std::optional<WalkMedium> walk = {};                     ///< if the profile is that of random walks
};

/// The outputs that a filter should have written, and bounds on how far a float32 device may be off.
struct Reference {
  Picture scattered;        ///< RGB, as Frame::scattered
  Picture scattered_bound;  ///< absolute, per value: rounding of a float32 device, derived per pixel
  Picture result;           ///< RGB, as Frame::result; empty if the frame has no beauty
  Picture result_bound;
  Picture touched;  ///< 1 channel: 1 where the filter scattered, 0 where it must leave the pixel alone
  Picture weights;  ///< RGB, of surface_integral alone: what it divides by where the filter scattered, else 0
};

/// Sums the taps of the separable filter pixel by pixel; see Taps. Where a pass has no taps for a pixel (level -1, or a
/// pixel that gives light but takes none) each term is its sum at one point: the light if normalised, else
/// Term::sum times the light; but the vertical pass restores pixels that take none. Pixels whose light or albedo is
/// not finite belong to the surface (they count for depths, slopes, levels and block classes) but neither give nor take
/// light. Reads the frame's host images. The bounds hold for outputs of float32: a caller that stores half adds half an
/// ulp of that. Where float32 cannot tell which level a block has or whether it is flat, they admit every outcome.
Reference separable(const Frame& frame, std::span<const Material> materials, const Options& options);

/// Computes the surface integral over all visible pixels of the material,
///     M(p) = sum_q R(|P_p - P_q|) E(q) A(q) / sum_q R(|P_p - P_q|) A(q),   A = |Tx x Ty|.
/// Tx and Ty are the change of position per pixel. The change of depth in them is the smaller one of the differences to
/// both neighbours of the same material, or 0 if they differ in sign. With one neighbour it is the difference to that,
/// and without any it is 0. R is averaged over the tangent patch of q by Gauss-Legendre quadrature: 4 x 4 points if q
/// is at most 2 pixels away on both axes, 2 x 2 up to 6, else the centre; the patch of p itself is integrated in polar
/// form, (1 / 2 pi) of the integral of cdf(boundary) over the angle, by 8-point Gauss-Legendre on each edge. `finer`
/// multiplies the number of quadrature points per axis, to show what they are worth. Leaves the bounds empty: what a
/// device adds is not derived here, but set by the tables of R that it reads.
Reference surface_integral(const Frame& frame, std::span<const Material> materials, const Options& options,
                           int finer = 1);

/// What enters where only the views of a frame look, per pixel that scatters; 0 for the others.
struct HiddenLight {
  Picture light;                 ///< RGB: sum of R E A over the hidden surface
  Picture weight;                ///< RGB: sum of R A
  Picture bent;                  ///< RGB: what curvature adds to the light of random walks
  std::vector<double> area_mm2;  ///< of the hidden surface of each material
};

/// Sums the light of every hidden sample for every pixel, out to any distance. The samples: a pixel of a view is a
/// parallelogram whose sides are the ways along the surface to the next pixels, each the mean of those to the next and
/// from the last one that face the same way, without one more than twice as long as the other, and no longer than 12.5
/// times the median of all shorter sides. It is hidden unless one of the 3 x 3 pixels of the frame about it shows its
/// material within 1.5 pixels of its plane, and it faces the camera. Its area is 1 over the sum of the pixels per area
/// of all views that show the place. It is split into k x k parts, at most 4 x 4, until they are no larger than 1 / 80
/// of the distance within which 99.7 % of the widest channel's light leaves. R of a part is R(sqrt(r^2 + 0.08 A)), for
/// a projected profile times r sum_a w_a / r_a: see Profile::projected. Of random walks, pairs that face away from each
/// other count as the faces of a slab, and curvature adds `bent`: METHODS.md, "Light from behind".
HiddenLight hidden_light(const Frame& frame, std::span<const Material> materials, const Options& options);

/// Estimates that integral by samples on discs; see DiscOptions. Of n samples sample i has the distance r at which the
/// share s/16 + (1 - s/16) (i + 1/2) / n of the widest channel's light has left, the direction i times the golden
/// angle, and stands for the area a = (1 - s/16) / (n R(r)). s is the largest number below 16 for which the first
/// sample, and half the root of its area, lie beyond the disc that fits into the pixel. Sample i weighs R(distance) a A
/// / D, A and D being the areas of surface and of disc under a pixel there, and the pixel itself as in
/// surface_integral; its shares of samples are left out. The bounds hold for a device that reads R and its cdf from
/// tables that are linear in r^2 between 256 nodes or more in each octave, and neglects R from the distance on within
/// which all but 1e-6 leaves. Where float32 cannot tell which pixels a sample reads, they admit every outcome.
Reference disc(const Frame& frame, std::span<const Material> materials, const Options& options);

}  // namespace dermis::oracle
