/// Diffusion profiles R(r), which say how far light spreads under a surface: one curve per colour channel.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dermis {

/// One value per channel: red, green, blue.
using Rgb = std::array<double, 3>;

/// One two-dimensional Gaussian of a sum: weight * exp(-r^2 / (2 v)) / (2 pi v).
struct GaussianTerm {
  double variance_mm2;  ///< v, mm^2, 1e-18..1e18
  Rgb weight;           ///< >= 0; a channel's weights are scaled to sum to 1
};

/// One row of a measured or simulated profile.
struct TableRow {
  double r_mm;  ///< 0, or 1e-9..1e9
  Rgb value;    ///< R(r) of each channel on any scale, >= 0
};

/// The factor k by which the albedo A of a pixel, clamped to 0..1, scales a profile: the profile there is R(r / k) /
/// k^2. A cubic over a quadratic, by rising powers of A, both above 0 in 0..1.
struct AlbedoWidth {
  std::array<double, 4> numerator;
  std::array<double, 3> denominator;

  bool operator==(const AlbedoWidth&) const = default;
};

class RadialCurve;  // one channel of a profile; not for callers

/// A radially symmetric diffusion profile R(r) in 1/mm^2 with unit integral over the plane in every
/// channel; the albedo is kept apart. Immutable; copies share their curves. Lengths are in millimetres, channels are
/// 0, 1, 2. Results are good to 1e-10 of their own size unless said otherwise, far out too.
class Profile {
 public:
  /// Burley's normalized diffusion, R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r)
  /// (Golubev 2018, with s = 1/d). `d_mm` in 1e-9..1e9, one per channel.
  /// Throws Error(usage) otherwise.
  static Profile burley(const Rgb& d_mm);

  /// Burley's profile from the mean free path l and the albedo of the surface: d = l / s(A),
  /// s(A) = 1.9 - A + 3.5 (A - 0.8)^2 (Christensen and Burley 2015, eq. 6). `mfp_mm` in 1e-9..1e9; `albedo` in [0, 1].
  static Profile burley_mfp(const Rgb& mfp_mm, const Rgb& albedo);

  /// Burley's profile from the radius that Cycles calls "Subsurface Radius" and a constant albedo:
  /// mean free path l = radius / (4 pi), d = l / s(A), s(A) = 1.9 - A + 3.5 (A - 0.8)^2
  /// (Christensen and Burley 2015, eq. 6). `radius_mm` in 1e-9..1e9; `albedo` in [0, 1].
  static Profile burley_cycles(const Rgb& radius_mm, const Rgb& albedo);

  /// Burley's profile from Cycles' radius and the albedo of each pixel: the frame has to carry an albedo image.
  static Profile burley_cycles(const Rgb& radius_mm);

  /// Cycles' random walk through a half-space, isotropic and with an index of refraction of 1.4, from the radius that
  /// Cycles calls "Subsurface Radius" and a constant albedo, which set its mean free path and what each scattering
  /// absorbs. A table of walks, whose cdf is off by 6e-4 at most. `radius_mm` in 1e-9..1e9; `albedo` in [0, 1].
  static Profile random_walk_cycles(const Rgb& radius_mm, const Rgb& albedo);

  /// The same with the albedo of each pixel: the walk of an albedo of 0.6, scaled so that its mean distance is that of
  /// the pixel's albedo, to 2 % in the mean of 0.05..0.8. The frame has to carry an albedo image.
  static Profile random_walk_cycles(const Rgb& radius_mm);

  /// The same from the mean free path itself.
  static Profile random_walk_mfp(const Rgb& mfp_mm, const Rgb& albedo);

  /// A sum of Gaussians (d'Eon and Luebke 2007, eq. 14.6). At least one term; every channel needs a
  /// positive weight.
  static Profile gaussians(const std::vector<GaussianTerm>& terms);

  /// The artist's pair of Gaussians: the marginal is w G(x; near) + (1 - w) G(x; far) (Jimenez et al. 2015, eq. 6), and
  /// R(r) the sum of the two Gaussians of the plane that have it. Standard deviations in 1e-9..1e9 mm, `near_weight`
  /// in [0, 1]. Near may be wider than far.
  static Profile artist(const Rgb& near_mm, const Rgb& far_mm, double near_weight);

  /// The dipole of a half-space of a medium (Jensen et al. 2001, eq. 4), without its albedo. Both coefficients in
  /// 1e-9..1e9 1/mm; the refractive index `eta` in 1..2.5.
  static Profile dipole(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, double eta = 1.3);

  /// The dipole with Grosjean's diffusion coefficient, and with the light that leaves made of fluence and flux
  /// (d'Eon 2012, "A better dipole"). Arguments as for `dipole`.
  static Profile better_dipole(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, double eta = 1.3);

  /// A table, interpolated by monotone cubics in r (Fritsch and Carlson 1980), constant below the first radius, 0
  /// beyond the last, and scaled to unit integral. At least two rows of ascending radius, and a value above 0 in every
  /// channel.
  static Profile tabulated(const std::vector<TableRow>& rows);

  /// R(r), 1/mm^2, for r_mm > 0. Burley's profile and random walks grow as 1/r towards r = 0.
  double radial(int channel, double r_mm) const;

  /// The pre-integrated kernel a(x) = integral of R(sqrt(x^2 + y^2)) over y, 1/mm (Jimenez et al. 2015,
  /// eq. 4), for x_mm != 0; even in x.
  double marginal(int channel, double x_mm) const;

  /// Share of the light of a point that arrives left of x: the integral of a from minus infinity to x.
  /// It is also what a straight shadow edge looks like: 0 far left, 1/2 at x = 0, 1 far right.
  double edge(int channel, double x_mm) const;

  /// 1 - edge(x), without cancellation far right.
  double edge_tail(int channel, double x_mm) const;

  /// Light between two parallel lines: the integral of a over from_mm..to_mm, in which `from_mm` <= `to_mm` and both
  /// may be infinite: the weight of a pixel in a row. Throws Error(usage) otherwise.
  double strip(int channel, double from_mm, double to_mm) const;

  /// Light on a rectangle: the integral of R over x0_mm..x1_mm by y0_mm..y1_mm about the point, under the same rule:
  /// the weight of a pixel in a picture. Good to 1e-8 of its own size for pixels of 1/40 to 20 times d, 1/sigma_tr or a
  /// standard deviation, down to 1e-12 of the pixel in the middle.
  double rectangle(int channel, double x0_mm, double x1_mm, double y0_mm, double y1_mm) const;

  /// The Fourier transform of R in the plane at an angular frequency in 1/mm, which is also that of a: 1 at 0, even.
  /// Good to 1e-9 of 1; for a table to 3e-8, between rows that are more than 1e5 / omega apart.
  double spectrum(int channel, double omega_per_mm) const;

  /// Share of the light of a point that leaves within the distance r (0..1).
  double cdf(int channel, double r_mm) const;

  /// T(s), the share of the light on one side of a slab of thickness s that leaves on the other, under the same light
  /// everywhere: the integral of R(sqrt(r^2 + s^2)) over the plane (Jimenez et al. 2010, eq. 7; Golubev 2018), which is
  /// the light beyond a distance s, 1 - cdf(s). For a sum of Gaussians that is the sum of w exp(-s^2 / 2v) (the paper
  /// drops the 2), for Burley's profile (e^(-s/d) + 3 e^(-s/3d)) / 4. T(0) = 1; T falls monotonically. thickness_mm >=
  /// 0, or infinite.
  double transmittance(int channel, double thickness_mm) const;

  /// The distance within which `share` (in [0, 1)) of the light leaves: the inverse of cdf. For Burley
  /// the closed form y = 2 sinh(asinh(2 (1 - u)) / 3), r = -3 d ln y.
  double radius(int channel, double share) const;

  /// The half-width x of the strip |x'| <= x that holds `share` (in [0, 1)) of a(x).
  double half_width(int channel, double share) const;

  /// The mean free path in the medium, 1 / (scattering + absorption) per mm, where the profile is one of a medium:
  /// random walks, dipoles (reduced scattering), and Burley's profile of a mean free path or a Cycles radius; else
  /// none.
  std::optional<double> mfp_mm(int channel) const;

  /// What a scattering leaves of the light, 0..1, where the profile is a random walk; else none.
  std::optional<double> scattering_albedo(int channel) const;

  /// The channel whose light spreads furthest.
  int widest_channel() const;

  /// True if both are of one kind and made of the same numbers: all their values are then the same.
  bool operator==(const Profile& other) const;

  /// True if a pixel's albedo sets how wide the profile is there: the profile of a pixel is then
  /// R(r / k) / k^2 with k = width_at(albedo) per channel.
  bool width_follows_albedo() const { return albedo_width_.has_value(); }
  const std::optional<AlbedoWidth>& albedo_width() const { return albedo_width_; }

  /// The same profile for surfaces that bend or lie across from each other as Cycles samples it: by distances on three
  /// planes, projected to the surface, without the change of area. Then more light comes through thin parts than by the
  /// distance in space. It tells for the exact method and for the light of views.
  Profile projected() const;
  bool is_projected() const { return is_projected_; }

  /// k for an albedo (clamped to 0..1), of which that of Burley's profile is 1 / s(A); 1 if the width does not follow
  /// it.
  double width_at(double albedo) const;

 private:
  friend struct ProfileContent content_of(const Profile& profile);
  explicit Profile(std::array<std::shared_ptr<const RadialCurve>, 3> curves, std::optional<Rgb> mfp_mm = {});
  static Profile walk_of(const Rgb& mfp_mm, const Rgb& albedo);
  const RadialCurve& curve(int channel) const { return *curves_[static_cast<std::size_t>(channel)]; }

  std::array<std::shared_ptr<const RadialCurve>, 3> curves_;
  std::optional<Rgb> mfp_mm_;
  std::optional<Rgb> scattering_albedo_;
  std::optional<AlbedoWidth> albedo_width_;
  bool is_projected_ = false;
};

/// A named profile and where its numbers come from.
struct Preset {
  std::string name;
  std::string source;
  Profile profile;
};

/// All presets, by name.
std::span<const Preset> presets();

/// The preset of that name. Throws Error(usage) that lists the names there are.
const Preset& preset(std::string_view name);

}  // namespace dermis
