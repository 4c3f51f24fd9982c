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
  // Normals of bumps and of rounded edges may lean away; the layer of highlights never takes more than that.
  const double c = std::clamp(cosine, 0.05, 1.0);
  return static_cast<float>(1 - 0.5 * std::pow(1 - c, 5));
}

}  // namespace

void take_out_view_factor(const exr::Picture& picture, const exr::Roles& roles, const exr::FoundCamera& camera,
                          std::vector<float>& light) {
  exr::require(picture, roles, Role::normal);
  exr::require(picture, roles, Role::position);
  if (!camera.eye)
    throw Error(ErrorCode::role_missing, "--view-factor", "a camera from " + camera.source,
                "a picture with positions that tell where its camera is");
  const std::vector<float> normal = exr::load(picture, roles, Role::normal);
  const std::vector<float> position = exr::load(picture, roles, Role::position);
  const bool is_parallel = camera.camera.projection == Camera::Projection::orthographic;
  const std::array<double, 3> eye = *camera.eye;
  for (std::size_t i = 0; i < light.size(); i += 3) {
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
    if (!std::isfinite(cosine)) continue;
    const float factor = factor_at(cosine);
    for (std::size_t k = 0; k < 3; ++k) light[i + k] /= factor;
  }
}

}  // namespace dermis::program
