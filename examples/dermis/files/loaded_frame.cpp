#include "files/loaded_frame.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>

#include "arguments/cryptomatte_argument.hpp"
#include "dermis/error.hpp"

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
          .matte = image_of(matte)};
}

void require_roles(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                   const Options& options, bool has_cryptomatte) {
  exr::require(picture, roles, Role::light);
  if (!roles.has(Role::position)) exr::require(picture, roles, Role::depth);
  if (options.lighting == Lighting::raw || options.albedo_mix > 0 || any_follows_albedo(profiles))
    exr::require(picture, roles, Role::albedo);
  if (have_ids(profiles) && !has_cryptomatte) exr::require(picture, roles, Role::material);
}

LoadedFrame load_images(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                        const std::vector<std::string>& cryptomatte) {
  LoadedFrame loaded{picture.width(), picture.height(), {}, {}, {}, {}, {}, {}};
  loaded.light = load_values(picture, roles, Role::light, 3);
  loaded.albedo = load_values(picture, roles, Role::albedo, 3);
  loaded.mask = load_values(picture, roles, Role::mask, 1);
  loaded.matte = load_values(picture, roles, Role::matte, 1);
  if (!cryptomatte.empty()) {
    NamedMattes mattes = load_named_mattes(picture, cryptomatte);
    loaded.material = std::move(mattes.ids);
    loaded.matte = std::move(mattes.shares);
  } else if (have_ids(profiles)) {
    loaded.material = load_values(picture, roles, Role::material, 1);
  }
  return loaded;
}

std::vector<float> load_depth_image(const exr::Picture& picture, const exr::Roles& roles,
                                    const exr::FoundCamera& camera) {
  return checked(exr::load_depth(picture, roles, camera), picture, Role::depth, 1);
}

}  // namespace dermis::program
