#include "files/loaded_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "arguments/cryptomatte_argument.hpp"
#include "dermis/error.hpp"
#include "files/surface_pixels.hpp"

namespace dermis::program {
namespace {

using exr::Role;

std::vector<float> checked(std::vector<float> values, const exr::Picture& picture, Role role, std::size_t channels) {
  const std::size_t pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  if (!values.empty() && values.size() != pixels * channels)
    throw Error(ErrorCode::input_unsupported, fmt::format("role {}", exr::name_of(role)),
                fmt::format("{} channels", values.size() / pixels), std::to_string(channels));
  return values;
}

std::vector<float> load_values(const exr::Picture& picture, const exr::Roles& roles, Role role, std::size_t channels) {
  return checked(exr::load(picture, roles, role), picture, role, channels);
}

}  // namespace

Frame LoadedFrame::frame() const {
  return {.width = width,
          .height = height,
          .light = image_of(light),
          .albedo = image_of(albedo),
          .depth = image_of(depth),
          .material = image_of(material),
          .mask = image_of(mask),
          .matte = image_of(matte),
          .normal = image_of(normal)};
}

std::vector<std::uint8_t> scattering_pixels(const LoadedFrame& loaded, const std::vector<NamedProfile>& profiles) {
  std::vector<std::uint8_t> scatters(loaded.light.size() / 3, 1);
  const auto keep_where = [&](const std::vector<float>& values, const auto& condition) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!condition(values[i])) scatters[i] = 0;
  };
  keep_where(loaded.depth, [](float depth) { return !is_background(depth); });
  keep_where(loaded.mask, [](float width) { return width > 0; });
  keep_where(loaded.matte, [](float share) { return share > 0; });
  keep_where(loaded.material, [&](float id) {
    return std::any_of(profiles.begin(), profiles.end(),
                       [&](const NamedProfile& named) { return static_cast<float>(named.id.value_or(-1)) == id; });
  });
  return scatters;
}

std::vector<float> scattering_light(const LoadedFrame& loaded, Lighting lighting, double albedo_mix) {
  constexpr float smallest_albedo = 1e-4F;  // as Lighting::lit says
  std::vector<float> light = loaded.light;
  for (std::size_t i = 0; i < loaded.albedo.size(); ++i) {
    const float albedo = loaded.albedo[i];
    if (lighting == Lighting::lit) light[i] = albedo >= smallest_albedo ? light[i] / albedo : 0;
    if (albedo_mix > 0) light[i] *= std::pow(std::max(albedo, 0.0F), static_cast<float>(albedo_mix));
  }
  return light;
}

void require_roles(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                   bool has_cryptomatte) {
  exr::require(picture, roles, Role::light);
  if (!roles.has(Role::position)) exr::require(picture, roles, Role::depth);
  // Light that is lit is divided by it, and light that is not is multiplied by it in the end.
  exr::require(picture, roles, Role::albedo);
  if (have_ids(profiles) && !has_cryptomatte) exr::require(picture, roles, Role::material);
}

LoadedFrame load_images(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                        const std::vector<MatteId>& mattes, const std::filesystem::path& folder) {
  LoadedFrame loaded{picture.width(), picture.height(), {}, {}, {}, {}, {}, {}, {}, {}};
  loaded.light = load_values(picture, roles, Role::light, 3);
  loaded.albedo = load_values(picture, roles, Role::albedo, 3);
  loaded.mask = load_values(picture, roles, Role::mask, 1);
  loaded.matte = load_values(picture, roles, Role::matte, 1);
  if (!mattes.empty()) {
    NamedMattes named = load_named_mattes(picture, roles, mattes, folder);
    loaded.material = std::move(named.ids);
    loaded.matte = std::move(named.shares);
    loaded.cryptomatte = std::move(named.cryptomatte);
  } else if (have_ids(profiles)) {
    loaded.material = load_values(picture, roles, Role::material, 1);
  }
  return loaded;
}

std::vector<float> load_depth_image(const exr::Picture& picture, const exr::Roles& roles,
                                    const exr::FoundCamera& camera) {
  return checked(exr::load_depth(picture, roles, camera), picture, Role::depth, 1);
}

bool any_walk(const std::vector<NamedProfile>& profiles) {
  return std::any_of(profiles.begin(), profiles.end(),
                     [](const NamedProfile& named) { return named.profile.scattering_albedo(0).has_value(); });
}

std::vector<float> load_normal_image(const exr::Picture& picture, const exr::Roles& roles,
                                     const exr::FoundCamera& camera) {
  if (!roles.has(Role::normal) || !camera.world_to_camera) return {};
  const std::array<double, 12>& turn = *camera.world_to_camera;
  std::vector<float> normal = load_values(picture, roles, Role::normal, 3);
  for (std::size_t i = 0; i < normal.size(); i += 3) {
    const std::array<double, 3> world = {normal[i], normal[i + 1], normal[i + 2]};
    for (std::size_t row = 0; row < 3; ++row) {
      normal[i + row] =
          static_cast<float>(turn[4 * row] * world[0] + turn[4 * row + 1] * world[1] + turn[4 * row + 2] * world[2]);
    }
  }
  return normal;
}

std::vector<float> load_depth_image(const exr::Picture& picture, const exr::Roles& roles) {
  if (roles.has(Role::depth)) return load_values(picture, roles, Role::depth, 1);
  const std::vector<float> position = load_values(picture, roles, Role::position, 3);
  std::vector<float> depth;
  for (std::size_t i = 0; i < position.size(); i += 3) {
    const auto* const p = &position[i];
    const bool is_there = std::isfinite(p[0] + p[1] + p[2]) && (p[0] != 0 || p[1] != 0 || p[2] != 0);
    depth.push_back(is_there ? 1 : std::numeric_limits<float>::infinity());
  }
  return depth;
}

}  // namespace dermis::program
