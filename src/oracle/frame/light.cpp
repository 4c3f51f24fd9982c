#include "oracle/frame/light.hpp"

#include <cmath>

namespace dermis::oracle {

namespace {

constexpr double least_albedo = static_cast<double>(1e-4F);  // Below it the irradiance counts as 0: see Lighting::lit.

}  // namespace

Light::Light(const FrameImages& images, const Options& options)
    : images_(images), lighting_(options.lighting), albedo_mix_(options.albedo_mix) {}

Bounded Light::irradiance(int x, int y, int c) const {
  const Bounded light = exact(images_.light(x, y, c));
  if (lighting_ == Lighting::raw || !has_albedo()) return light;
  const double albedo = images_.albedo(x, y, c);
  return albedo >= least_albedo ? light / exact(albedo) : exact(0);
}

// Besides the error of pow itself, the exponent (m or 1 - m) is rounded up to twice, which changes rho^m by at most
// the share 2 u |ln rho|.
Bounded Light::albedo_power(int x, int y, int c, double exponent) const {
  if (!has_albedo() || exponent == 0) return exact(1);
  const double albedo = std::fmax(images_.albedo(x, y, c), 0.0);  // An albedo that is not a number becomes 0.
  if (albedo == 0) return exact(0);
  return rounded(exact(std::pow(albedo, exponent)), power_roundings + 2 * std::abs(std::log(albedo)));
}

Bounded Light::filtered(int x, int y, int c) const { return irradiance(x, y, c) * albedo_power(x, y, c, albedo_mix_); }

BoundedPicture Light::filtered() const {
  BoundedPicture picture(images_.light.width, images_.light.height);
  for (int y = 0; y < picture.value.height; ++y) {
    for (int x = 0; x < picture.value.width; ++x) {
      for (int c = 0; c < 3; ++c) picture.set(x, y, c, filtered(x, y, c));
    }
  }
  return picture;
}

Bounded Light::composed(int x, int y, int c, Bounded scattered) const {
  const Bounded light = exact(images_.light(x, y, c));
  const Bounded albedo = exact(has_albedo() ? images_.albedo(x, y, c) : 1);
  const Bounded diffuse = lighting_ == Lighting::raw ? albedo * light : light;
  if (albedo_mix_ == 0 && lighting_ == Lighting::raw) return beauty(x, y, c) + (albedo * scattered - diffuse);
  return beauty(x, y, c) + (albedo_power(x, y, c, 1 - albedo_mix_) * scattered - diffuse);
}

}  // namespace dermis::oracle
