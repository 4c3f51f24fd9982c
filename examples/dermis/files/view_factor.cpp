#include "files/view_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "dermis/error.hpp"

namespace dermis::program {
namespace {

using exr::Role;

float factor_at(double cosine) {
  // Normals of bumps and of rounded edges may lean away from the camera: they count as seen edge-on.
  const double c = std::clamp(cosine, 0.05, 1.0);
  return static_cast<float>(1 - 0.5 * std::pow(1 - c, 5));
}

}  // namespace

std::vector<float> view_factors(const exr::Picture& picture, const exr::Roles& roles, const exr::FoundCamera& camera) {
  exr::require(picture, roles, Role::normal);
  exr::require(picture, roles, Role::position);
  if (!camera.eye)
    throw Error(ErrorCode::role_missing, "--view-factor", "a camera from " + camera.source,
                "a picture with positions that tell where its camera is");
  const std::vector<float> normal = exr::load(picture, roles, Role::normal);
  const std::vector<float> position = exr::load(picture, roles, Role::position);
  const bool is_parallel = camera.camera.projection == Camera::Projection::orthographic;
  const std::array<double, 3> eye = *camera.eye;
  std::vector<float> factors(position.size() / 3, 1.0F);
  for (std::size_t i = 0; i < position.size(); i += 3) {
    double along = 0;
    double rays = 0;
    double normals = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double ray = is_parallel ? -eye[k] : eye[k] - static_cast<double>(position[i + k]);
      const double n = static_cast<double>(normal[i + k]);
      along += ray * n;
      rays += ray * ray;
      normals += n * n;
    }
    const double cosine = along / std::sqrt(rays * normals);
    if (std::isfinite(cosine)) factors[i / 3] = factor_at(cosine);
  }
  return factors;
}

void take_out(const std::vector<float>& factors, std::vector<float>& light) {
  for (std::size_t i = 0; i < light.size(); ++i) light[i] /= factors[i / 3];
}

void add_gain(const std::vector<float>& factors, const LoadedFrame& loaded, Lighting lighting,
              std::vector<float>& beauty) {
  for (std::size_t i = 0; i < beauty.size(); ++i) {
    if (factors[i / 3] == 1) continue;
    const float share = loaded.matte.empty() ? 1.0F : std::clamp(loaded.matte[i / 3], 0.0F, 1.0F);
    const float albedo = lighting == Lighting::raw ? loaded.albedo[i] : 1.0F;
    const float gain = share * albedo * loaded.light[i] * (1 - factors[i / 3]);
    if (std::isfinite(gain)) beauty[i] += gain;
  }
}

}  // namespace dermis::program
