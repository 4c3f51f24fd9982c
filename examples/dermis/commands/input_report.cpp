#include "commands/input_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "dermis/error.hpp"
#include "dermis/words.hpp"
#include "exr/frame_match.hpp"
#include "files/surface_pixels.hpp"
#include "report/role_text.hpp"

namespace dermis::program {
namespace {

using exr::Role;

constexpr double smallest_radius_px = 0.5;  // below it a pixel keeps nearly all of its light

bool is_bad(const std::vector<float>& rgb, std::size_t pixel) {
  for (std::size_t c = 3 * pixel; c < 3 * pixel + 3 && c < rgb.size(); ++c)
    if (!std::isfinite(rgb[c])) return true;
  return false;
}

bool can_be_added(const std::vector<float>& light, std::size_t pixel) {
  for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c)
    if (!(std::abs(light[c]) <= largest_light)) return false;
  return true;
}

std::string text_of_light(const SurfaceInput& input) {
  const std::vector<std::string>& missing = input.roles.missing_light;
  return fmt::format(", {}{}{}", name_of(input.lighting), missing.empty() ? "" : ", without ",
                     fmt::join(missing, ", "));
}

/// The first pass of a renderer's light is what comes from lamps: without it the picture is of bounces alone.
void check_direct_light(const exr::Roles& roles, Messages& messages) {
  const exr::Renderer* renderer = exr::find_renderer(roles.renderer);
  if (renderer == nullptr || roles.missing_light.empty()) return;
  const auto first = std::find_if(renderer->passes.begin(), renderer->passes.end(),
                                  [](const exr::Renderer::Pass& pass) { return pass.role == Role::light; });
  if (first->names.front() == roles.missing_light.front())
    messages.warn(ErrorCode::role_missing, "light",
                  fmt::format("no pass {} beside {}, which alone scatters; want it, or --role light=CHANNELS",
                              first->names.front(), program::text_of(roles[Role::light])));
}

std::string text_of_roles(const SurfaceInput& input) {
  const exr::Roles& roles = input.roles;
  std::string text;
  for (const Role role : {Role::light, Role::albedo, Role::depth, Role::position, Role::material, Role::mask,
                          Role::matte, Role::beauty}) {
    if (!roles.has(role)) continue;
    if (role == Role::material && input.loaded.material.empty()) continue;
    if ((role == Role::material || role == Role::matte) && !input.loaded.cryptomatte.empty()) continue;
    text += fmt::format("{}{} {} ({}{})", text.empty() ? "" : "; ", exr::name_of(role), program::text_of(roles[role]),
                        roles.rules[static_cast<std::size_t>(role)], role == Role::light ? text_of_light(input) : "");
  }
  if (!input.loaded.cryptomatte.empty()) text += fmt::format("; materials {}", input.loaded.cryptomatte);
  if (!roles.has(Role::beauty)) text += "; no beauty, so that only the scattered light is written";
  return text;
}

std::string text_of(const LeftOut& left_out) {
  std::string text;
  const auto add = [&](std::int64_t pixels, const char* what) {
    if (pixels > 0) text += fmt::format("{}{} pixels {}", text.empty() ? "" : ", ", pixels, what);
  };
  add(left_out.background, "of a material that have no depth");
  add(left_out.bad_light, "with light that is not finite, or beyond 1e32");
  add(left_out.bad_albedo, "with an albedo that is not finite");
  add(left_out.bad_depth, "with a depth that is not a number");
  return text;
}

/// How far the profile reaches, px, along the axis that has the smaller pixels.
void report_material(const NamedProfile& named, const MaterialPixels& pixels, const SurfaceInput& input,
                     Messages& messages) {
  const std::string name = option_text(named);
  const double radius_mm = kernel_radius_mm(named.profile);
  if (!pixels.pixel_mm) {
    if (pixels.pixels > 0)
      messages.warn(ErrorCode::role_missing, name,
                    fmt::format("all of its {} pixels are background by their depth", pixels.pixels));
    return;
  }
  const double median_px = radius_mm / *pixels.pixel_mm;
  const double largest_px = radius_mm / pixels.finest_pixel_mm.value_or(*pixels.pixel_mm);
  messages.input(fmt::format("{} {}: {} pixels, kernel radius {:.3g} px in the median, {:.3g} px at most", name,
                             named.text, pixels.pixels, median_px, largest_px));
  const int side_px = std::max(input.picture.width(), input.picture.height());
  if (largest_px < smallest_radius_px)
    messages.warn(
        ErrorCode::usage, "--mm-per-unit",
        fmt::format("{} reaches {:.2g} px at most: it changes nothing that can be seen; want another scale, if "
                    "that is not so",
                    name, largest_px));
  else if (median_px > side_px)
    messages.warn(
        ErrorCode::usage, "--mm-per-unit",
        fmt::format("{} reaches {:.3g} px, beyond the picture of {} px; want another scale, if that is not so", name,
                    median_px, side_px));
}

}  // namespace

void warn_of_input(const exr::Roles& roles, const exr::FoundCamera& camera, Messages& messages) {
  for (const std::string& warning : roles.warnings) messages.warn(ErrorCode::input_unsupported, "--role", warning);
  for (const std::string& warning : camera.warnings) messages.warn(ErrorCode::role_missing, "camera", warning);
}

LeftOut count_left_out(const SurfaceInput& input, const SurfaceRequest& request) {
  const LoadedFrame& loaded = input.loaded;
  const std::vector<float> beauty = exr::load(input.picture, input.roles, Role::beauty);
  LeftOut left_out;
  std::vector<bool> lacks_depth(loaded.light.size() / 3);
  for (std::size_t i = 0; i < loaded.light.size() / 3; ++i) {
    const float depth = loaded.depth.empty() ? 1.0F : loaded.depth[i];
    const bool is_behind = is_background(depth);
    if (!loaded.material.empty()) {
      const float id = loaded.material[i];
      const bool is_asked = std::any_of(request.profiles.begin(), request.profiles.end(), [&](const NamedProfile& its) {
        return its.id && static_cast<float>(*its.id) == id;
      });
      lacks_depth[i] = is_behind && is_asked;
      if (lacks_depth[i]) ++left_out.background;
      if (!is_behind && loaded.cryptomatte.empty() && id != std::floor(id)) ++left_out.fractional_ids;
    }
    if (!can_be_added(loaded.light, i)) ++left_out.bad_light;
    if (is_bad(loaded.albedo, i)) ++left_out.bad_albedo;
    if (std::isnan(depth)) ++left_out.bad_depth;
    if (is_bad(beauty, i)) ++left_out.bad_beauty;
  }
  left_out.inner_background = exr::count_inner(lacks_depth, loaded.width);
  return left_out;
}

void report_input(const SurfaceInput& input, const SurfaceRequest& request, const std::vector<MaterialPixels>& pixels,
                  const LeftOut& left_out, Messages& messages) {
  const std::string place = (input.roles.layer.empty() ? "" : " of layer " + input.roles.layer) +
                            (input.roles.view.empty() ? "" : " of view " + input.roles.view);
  messages.input(fmt::format("channels{}: {}", place, text_of_roles(input)));
  messages.input(fmt::format("camera: {}", text_of(input.camera)));
  for (std::size_t i = 0; i < pixels.size(); ++i) report_material(request.profiles[i], pixels[i], input, messages);
  if (const std::string text = text_of(left_out); !text.empty()) messages.input("left out: " + text);
  if (!input.view_factors.empty()) messages.input("view factor: principled, taken out of the light that scatters");
  if (request.curvature && any_walk(request.profiles))
    messages.input(input.loaded.normal.empty()
                       ? "curvature: none, as there are no normals, or it is not known where the camera is"
                       : "curvature: by the normals, for random walks");
  check_direct_light(input.roles, messages);
  if (left_out.fractional_ids > 0)
    messages.warn(ErrorCode::input_unsupported, "material",
                  fmt::format("{} pixels do not scatter, as their ids are no whole numbers; want ids that are not "
                              "antialiased, or names of a Cryptomatte",
                              left_out.fractional_ids));
  const auto add = [](std::int64_t sum, const MaterialPixels& its) { return sum + its.pixels; };
  const exr::FrameMatch ids{std::accumulate(pixels.begin(), pixels.end(), std::int64_t{0}, add),
                            left_out.inner_background};
  if (!ids.is_one_frame())
    messages.warn(ErrorCode::input_unsupported, "material",
                  fmt::format("{} pixels have no depth, and all around them have none; want ids and depth of one frame",
                              left_out.background));
  if (left_out.bad_beauty > 0)
    messages.warn(ErrorCode::input_unsupported, "beauty",
                  fmt::format("{} pixels are not finite; they stay as they are", left_out.bad_beauty));
  if (!request.lighting && input.roles.renderer.empty())
    messages.warn(ErrorCode::role_missing, "--lighting",
                  fmt::format("nothing says whether the albedo is in the light: it is taken for {}; want raw or lit",
                              name_of(input.lighting)));
}

}  // namespace dermis::program
