/// How far light spreads under a surface: the diffusion profile R(r), one curve per colour channel.
#pragma once

#include <array>
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

/// A radially symmetric diffusion profile R(r) in 1/mm^2 with unit integral over the plane in every
/// channel; the albedo is kept apart. Immutable. Lengths are in millimetres, channels are 0, 1, 2.
class Profile {
 public:
  /// Burley's normalized diffusion, R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r)
  /// (Golubev 2018, with s = 1/d). `d_mm` in 1e-9..1e9, one per channel.
  /// Throws Error(usage) otherwise.
  static Profile burley(const Rgb& d_mm);

  /// Burley's profile from the radius that Cycles calls "Subsurface Radius" and a constant albedo:
  /// mean free path l = radius / (4 pi), d = l / s(A), s(A) = 1.9 - A + 3.5 (A - 0.8)^2
  /// (Christensen and Burley 2015, eq. 6). `radius_mm` in 1e-9..1e9; `albedo` in [0, 1].
  static Profile burley_cycles(const Rgb& radius_mm, const Rgb& albedo);

  /// The same with the albedo of each pixel: the frame has to carry an albedo image.
  static Profile burley_cycles(const Rgb& radius_mm);

  /// A sum of Gaussians (d'Eon and Luebke 2007, eq. 14.6). At least one term; every channel needs a
  /// positive weight.
  static Profile gaussians(const std::vector<GaussianTerm>& terms);

  /// R(r), 1/mm^2, for r_mm > 0. Burley's profile grows as 1/r towards r = 0.
  double radial(int channel, double r_mm) const;

  /// The pre-integrated kernel a(x) = integral of R(sqrt(x^2 + y^2)) over y, 1/mm (Jimenez et al. 2015,
  /// eq. 4), for x_mm != 0; even in x.
  double marginal(int channel, double x_mm) const;

  /// Share of the light of a point that arrives left of x: the integral of a from minus infinity to x.
  /// It is also what a straight shadow edge looks like: 0 far left, 1/2 at x = 0, 1 far right.
  double edge(int channel, double x_mm) const;

  /// 1 - edge(x), without cancellation far right.
  double edge_tail(int channel, double x_mm) const;

  /// Share of the light of a point that leaves within the distance r (0..1).
  double cdf(int channel, double r_mm) const;

  /// The distance within which `share` (in [0, 1)) of the light leaves: the inverse of cdf. For Burley
  /// the closed form y = 2 sinh(asinh(2 (1 - u)) / 3), r = -3 d ln y.
  double radius(int channel, double share) const;

  /// The half-width x of the strip |x'| <= x that holds `share` (in [0, 1)) of a(x).
  double half_width(int channel, double share) const;

  /// The channel whose light spreads furthest.
  int widest_channel() const;

  /// True if a pixel's albedo sets how wide the profile is there: the profile of a pixel is then
  /// R(r / k) / k^2 with k = width_at(albedo) per channel.
  bool width_follows_albedo() const { return width_follows_albedo_; }

  /// k for an albedo (clamped to 0..1): 1 / s(A) where the width follows the albedo, else 1.
  double width_at(double albedo) const;

 private:
  struct ChannelTerm {
    double weight;
    double variance_mm2;
  };

  std::array<double, 3> burley_d_mm_{};                ///< used if gaussians_ is empty
  std::array<std::vector<ChannelTerm>, 3> gaussians_;  ///< only terms with weight > 0
  bool width_follows_albedo_ = false;
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
