// dermis info: what a picture holds, and what the filter would make of it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments/cache_argument.hpp"
#include "arguments/device_arguments.hpp"
#include "arguments/material_arguments.hpp"
#include "arguments/picture_arguments.hpp"
#include "arguments/profile_argument.hpp"
#include "arguments/quality_arguments.hpp"
#include "commands/commands.hpp"
#include "commands/input_report.hpp"
#include "commands/unseen_weight.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "exr/message_text.hpp"
#include "files/loaded_frame.hpp"
#include "files/picture_roles.hpp"
#include "files/surface_pixels.hpp"
#include "report/json_text.hpp"
#include "report/messages.hpp"
#include "report/role_text.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

using exr::Role;
using nlohmann::json;

struct InfoArguments {
  std::string path;
  PictureArguments picture;
  MaterialArguments materials;
  std::optional<std::string> cache_dir;  ///< as cache_folder_of takes it
  bool views = false;                    ///< whether the camera sees what the profiles reach
  bool json = false;
};

/// The distance that a profile reaches.
struct Reach {
  std::string profile;
  double radius_mm = 0;
  std::optional<std::array<double, 2>> radius_px;  ///< in x and y at the median depth, if camera and scale are known
};

struct Surface {
  std::optional<int> id;            ///< none: every pixel
  std::optional<std::string> name;  ///< in a Cryptomatte
  SurfacePixels pixels;
  std::optional<Reach> reach;          ///< if a profile was given for it
  std::optional<UnseenWeight> unseen;  ///< if it was asked for
};

struct Memory {
  std::size_t working_bytes = 0;  ///< the filter's own images
  std::size_t image_bytes = 0;    ///< the frame's
};

struct Info {
  std::string path;
  exr::Picture picture;
  exr::Roles roles;
  std::vector<exr::Cryptomatte> cryptomattes;
  std::optional<exr::FoundCamera> camera;
  std::string camera_problem;  ///< why there is none
  std::vector<Surface> surfaces;
  std::int64_t pixels_without_id = 0;
  std::optional<Memory> memory;
};

void find_camera(Info& info, const exr::CameraHint& hint) {
  try {
    info.camera = exr::find_camera(info.picture, info.roles, hint);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::role_missing) throw;
    info.camera_problem = error.what();
  }
}

Reach reach_of(const NamedProfile& named, const SurfacePixels& pixels, const Info& info,
               const std::optional<double>& mm_per_unit) {
  Reach reach{without_folders(named.text), kernel_radius_mm(named.profile), {}};
  if (info.camera && mm_per_unit && pixels.median_depth_units) {
    const auto scale = px_per_mm(info.camera->camera, *pixels.median_depth_units, *mm_per_unit);
    reach.radius_px = {reach.radius_mm * scale[0], reach.radius_mm * scale[1]};
  }
  return reach;
}

void find_surfaces(Info& info, const std::vector<NamedProfile>& profiles, const std::optional<double>& mm_per_unit) {
  const std::vector<float> depth = exr::load_depth(info.picture, info.roles, info.camera.value_or(exr::FoundCamera{}));
  const std::vector<MatteId> mattes = mattes_of(profiles);
  MaterialCounts counts =
      count_materials(mattes.empty() ? exr::load(info.picture, info.roles, Role::material)
                                     : load_named_mattes(info.picture, info.roles, mattes, folder_of(info.path)).ids,
                      depth);
  info.pixels_without_id = counts.without_id;
  for (const NamedProfile& named : profiles) {
    if (named.id) {
      counts.by_id[*named.id];
      continue;
    }
    Surface all{{}, {}, count_surface(depth, exr::load(info.picture, info.roles, Role::mask)), {}, {}};
    all.reach = reach_of(named, all.pixels, info, mm_per_unit);
    info.surfaces.push_back(all);
  }
  for (const auto& [id, pixels] : counts.by_id) {
    Surface surface{id, {}, pixels, {}, {}};
    for (const NamedProfile& named : profiles) {
      if (named.id != id) continue;
      surface.name = named.name;
      surface.reach = reach_of(named, pixels, info, mm_per_unit);
    }
    info.surfaces.push_back(surface);
  }
}

/// Throws Error(usage or role_missing) if the arguments or the picture do not tell it.
void find_unseen(Info& info, const InfoArguments& arguments, const std::vector<NamedProfile>& profiles) {
  if (profiles.empty())
    throw Error(ErrorCode::usage, "--views", "it without --material and --profile", "profiles that scatter");
  if (!arguments.picture.mm_per_unit)
    throw Error(ErrorCode::usage, "--mm-per-unit", "nothing", "millimetres per scene unit, for --views");
  if (!info.camera) throw Error(ErrorCode::role_missing, "--views", info.camera_problem, "a camera");
  const std::vector<UnseenWeight> all =
      find_unseen_weights(info.picture, info.roles, *info.camera, profiles, *arguments.picture.mm_per_unit,
                          folder_of(info.path), cache_folder_of(arguments.cache_dir));
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    for (Surface& surface : info.surfaces) {
      if (surface.id == profiles[i].id) surface.unseen = all[i];
    }
  }
}

/// The images of frames of the picture, as load_images makes them; none if a role has the wrong channels for it.
std::optional<FrameDescription> describe_frame(const Info& info, bool has_ids) {
  for (const Role role : {Role::light, Role::albedo, Role::depth, Role::material, Role::mask, Role::matte}) {
    const bool is_read = role != Role::material || has_ids;
    const exr::ChannelSum& sum = info.roles[role];
    const bool fits = std::all_of(sum.begin(), sum.end(),
                                  [&](const auto& group) { return group.size() == exr::info_of(role).values; });
    if (is_read && !fits) return std::nullopt;
  }
  const exr::Roles& roles = info.roles;
  return FrameDescription{.depth = roles.has(Role::depth) || (info.camera && info.camera->axis),
                          .material = has_ids,
                          .mask = roles.has(Role::mask),
                          .albedo = roles.has(Role::albedo),
                          .matte = roles.has(Role::matte)};
}

/// Of the images that are read, and of the scattered light.
std::size_t bytes_of_pixel(const FrameDescription& frame) {
  const std::size_t rgb = 3 * (1 + std::size_t{frame.albedo} + 1);  // light, albedo, scattered light
  const std::size_t single = std::size_t{frame.depth} + frame.material + frame.mask + frame.matte;
  return (rgb + single) * bytes_of(Format::f32);
}

/// The materials of the profiles, with the sizes of their pixels as far as camera and scale tell them.
std::vector<Material> materials_of(const Info& info, const std::vector<NamedProfile>& profiles,
                                   const std::optional<double>& mm_per_unit) {
  std::vector<Material> materials = program::materials_of(profiles);
  if (!info.camera || !mm_per_unit) return materials;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const auto surface = std::find_if(info.surfaces.begin(), info.surfaces.end(),
                                      [&](const Surface& its) { return its.id == profiles[i].id; });
    if (surface == info.surfaces.end()) continue;
    const auto pixel_mm = [&](const std::optional<double>& depth_units) {
      return pixel_mm_at(depth_units, info.camera->camera, *mm_per_unit).value_or(0);
    };
    materials[i].pixel_mm = pixel_mm(surface->pixels.median_depth_units);
    materials[i].finest_pixel_mm = pixel_mm(surface->pixels.nearest_depth_units);
  }
  return materials;
}

/// The memory that a run of the filter would need with no more options than these, if the roles are there and a device
/// can tell.
std::optional<Memory> find_memory(const Info& info, const std::vector<NamedProfile>& profiles,
                                  const std::optional<double>& mm_per_unit, const std::string& cache_folder) {
  try {
    const std::vector<NamedProfile> asked =
        profiles.empty() ? std::vector<NamedProfile>{{{}, {}, presets().front().name, presets().front().profile}}
                         : profiles;
    const Options options{.quality = default_quality, .cache_folder = cache_folder};
    require_roles(info.picture, info.roles, asked, !mattes_of(asked).empty());
    const auto frames = describe_frame(info, have_ids(asked));
    if (!frames) return std::nullopt;
    std::size_t pixel_bytes = bytes_of_pixel(*frames);
    if (info.roles.has(Role::beauty)) {
      const Format format = info.picture.view(info.roles[Role::beauty].front()).layout.format;
      pixel_bytes += 2 * 3 * bytes_of(format);  // read and written
    }
    const int width = info.picture.width();
    const int height = info.picture.height();
    const std::vector<Material> materials = materials_of(info, asked, mm_per_unit);
    return Memory{Plan::scratch_bytes(open_device({}), materials, *frames, options, width, height),
                  pixel_bytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)};
  } catch (const Error&) {
    return std::nullopt;
  }
}

json json_of(const exr::Window& window) {
  return {{"x", window.x}, {"y", window.y}, {"width", window.width}, {"height", window.height}};
}

json json_of(const Surface& surface) {
  json object = {{"id", surface.id ? json(*surface.id) : json(nullptr)},
                 {"name", surface.name ? json(*surface.name) : json(nullptr)},
                 {"pixels", surface.pixels.pixels}};
  const auto& depth = surface.pixels.median_depth_units;
  object["median_depth_units"] = depth ? json(*depth) : json(nullptr);
  if (!surface.reach) return object;
  object["profile"] = surface.reach->profile;
  object["radius_mm"] = surface.reach->radius_mm;
  object["radius_px"] = surface.reach->radius_px ? json(*surface.reach->radius_px) : json(nullptr);
  if (const auto& unseen = surface.unseen)
    object["unseen"] = {{"mean_share", unseen->mean_share}, {"pixels_missing", unseen->pixels_missing}};
  return object;
}

std::string json_text_of(const Info& info) {
  json object = {{"file", info.path},
                 {"width", info.picture.width()},
                 {"height", info.picture.height()},
                 {"data_window", json_of(info.picture.data_window())},
                 {"display_window", json_of(info.picture.display_window())},
                 {"pixel_aspect", info.picture.pixel_aspect()},
                 {"compression", info.picture.compression()},
                 {"channels", info.picture.channels().size()},
                 {"views", info.picture.views()},
                 {"roles", program::json_of(info.roles)},
                 {"cryptomattes", json::array()},
                 {"materials", json::array()},
                 {"pixels_without_id", info.pixels_without_id}};
  for (const auto& [name, names] : info.cryptomattes) {
    json entry = {{"name", name}, {"names", json::array()}};
    for (const auto& [of, pixels] : names) entry["names"].push_back({{"name", of}, {"pixels", pixels}});
    object["cryptomattes"].push_back(std::move(entry));
  }
  object["camera"] = info.camera ? program::json_of(*info.camera) : json(nullptr);
  if (!info.camera) object["camera_problem"] = info.camera_problem;
  for (const Surface& surface : info.surfaces) object["materials"].push_back(json_of(surface));
  object["device_memory_bytes"] =
      info.memory ? json{{"working", info.memory->working_bytes}, {"images", info.memory->image_bytes}} : json(nullptr);
  return json_text(object);
}

std::string text_of(const exr::Window& window) {
  return fmt::format("{} x {} at ({}, {})", window.width, window.height, window.x, window.y);
}

std::string text_of(const Surface& surface) {
  std::string text = fmt::format("  {:<8} {:>10} pixels",
                                 surface.name ? exr::escaped(*surface.name)
                                 : surface.id ? std::to_string(*surface.id)
                                              : "any",
                                 surface.pixels.pixels);
  if (surface.pixels.median_depth_units)
    text += fmt::format(", median depth {:.6g} units", *surface.pixels.median_depth_units);
  if (surface.reach) {
    text += fmt::format(", {}: radius {:.3g} mm", surface.reach->profile, surface.reach->radius_mm);
    if (const auto& px = surface.reach->radius_px) text += fmt::format(", {:.3g} x {:.3g} px", (*px)[0], (*px)[1]);
  }
  if (const auto& unseen = surface.unseen)
    text += fmt::format(
        "\n           {:.2g} % of its weight at least lies where the camera does not look, more than 10 % "
        "at {:.2g} % of the pixels",
        100 * unseen->mean_share, 100 * unseen->pixels_missing);
  return text + "\n";
}

std::string text_of(const Info& info) {
  std::string text = fmt::format("file            {}\n", exr::escaped(info.path));
  text += fmt::format("data window     {}\n", text_of(info.picture.data_window()));
  text += fmt::format("display window  {}\n", text_of(info.picture.display_window()));
  text += fmt::format("pixel aspect    {}\n", info.picture.pixel_aspect());
  text += fmt::format("compression     {}\n", info.picture.compression());
  text += fmt::format("channels        {}\n", info.picture.channels().size());
  text += fmt::format("layer           {}\n", info.roles.layer.empty() ? "none" : exr::escaped(info.roles.layer));
  if (const auto views = info.picture.views(); !views.empty())
    text += fmt::format("views           {}, of which this is {}\n",
                        exr::escaped(fmt::format("{}", fmt::join(views, ", "))), exr::escaped(info.roles.view));
  text += fmt::format("renderer        {}\n",
                      info.roles.renderer.empty()
                          ? "none whose names are known"
                          : fmt::format("{}, light {}", info.roles.renderer, name_of(info.roles.lighting)));
  text += "roles\n";
  for (const exr::RoleInfo& role : exr::role_table)
    text += fmt::format("  {:<13} {}\n", role.name, program::text_of(info.roles[role.role]));
  for (const auto& [name, names] : info.cryptomattes) {
    text += fmt::format("cryptomatte     {}{}\n", exr::escaped(name),
                        names.empty() ? ", without a manifest of its names" : "");
    for (const auto& [of, pixels] : names) text += fmt::format("  {:<30} {:>10} pixels\n", exr::escaped(of), pixels);
  }
  text += fmt::format("camera          {}\n",
                      info.camera ? program::text_of(*info.camera) : "none, " + exr::escaped(info.camera_problem));
  if (!info.surfaces.empty()) text += "materials\n";
  for (const Surface& surface : info.surfaces) text += text_of(surface);
  if (info.pixels_without_id > 0) text += fmt::format("  {:<8} {:>10} pixels\n", "no id", info.pixels_without_id);
  if (info.memory) {
    constexpr double mib = 1024 * 1024;
    text += fmt::format("device memory   {:.1f} MiB working images, {:.1f} MiB images of the frame\n",
                        static_cast<double>(info.memory->working_bytes) / mib,
                        static_cast<double>(info.memory->image_bytes) / mib);
  }
  return text;
}

int run_info(const InfoArguments& arguments) {
  const std::vector<NamedProfile> profiles = parse_profiles(arguments.materials);
  Info info{arguments.path, exr::Picture::read(arguments.path), {}, {}, {}, {}, {}, 0, {}};
  info.roles = roles_of(info.picture, frame_file(arguments.path), arguments.picture,
                        views_of(info.picture, arguments.picture).front());
  info.cryptomattes = exr::find_cryptomattes(info.picture, info.roles, folder_of(arguments.path));
  find_camera(info, arguments.picture.camera);
  Messages messages({});
  messages.begin(arguments.path);
  warn_of_input(info.roles, info.camera.value_or(exr::FoundCamera{}), messages);
  find_surfaces(info, profiles, arguments.picture.mm_per_unit);
  if (arguments.views) find_unseen(info, arguments, profiles);
  info.memory = find_memory(info, profiles, arguments.picture.mm_per_unit, cache_folder_of(arguments.cache_dir));
  print(arguments.json ? json_text_of(info) : text_of(info));
  return 0;
}

}  // namespace

Command add_info(CLI::App& parent) {
  CLI::App* app = parent.add_subcommand("info", "what a picture holds, and what the filter would make of it");
  const auto arguments = std::make_shared<InfoArguments>();
  app->add_option("file", arguments->path, "the OpenEXR file to read")->required()->type_name("FILE");
  add_role_arguments(*app, arguments->picture);
  add_eye_argument(*app, arguments->picture);
  add_scale_argument(*app, arguments->picture);
  add_camera_arguments(*app, arguments->picture);
  add_material_arguments(*app, arguments->materials);
  add_cache_argument(*app, arguments->cache_dir);
  app->add_flag(
      "--views", arguments->views,
      "also how much of what each profile reaches lies where the camera does not look, as far as depth tells: "
      "whether --view of the filter is worth it");
  app->add_flag("--json", arguments->json, "as JSON");
  return {app, [arguments] { return run_info(*arguments); }};
}

}  // namespace dermis::program
