#include "files/renderer_file.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "files/input_file.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

constexpr const char* wanted_form =
    R"(as {"lighting": "raw", "roles": {"light": ["direct", "indirect"], "albedo": "colour"}})";

[[noreturn]] void refuse(const std::string& path, const std::string& seen, const std::string& want) {
  throw Error(ErrorCode::input_unsupported, "--preset " + path, seen, want);
}

/// One name, or several of which the first counts that is there.
std::vector<std::string> names_of(const json& value, const std::string& path) {
  if (value.is_string()) return {value.get<std::string>()};
  std::vector<std::string> names;
  if (!value.is_array() || value.empty()) refuse(path, printed(value), "the name of a pass, or a list of names");
  for (const json& name : value) {
    if (!name.is_string()) refuse(path, printed(name), "the name of a pass");
    names.push_back(name.get<std::string>());
  }
  return names;
}

void add_role(exr::Renderer& renderer, const std::string& name, const json& passes, const std::string& path) {
  const auto* const role = std::find_if(exr::role_table.begin(), exr::role_table.end(),
                                        [&](const exr::RoleInfo& info) { return info.name == name; });
  if (role == exr::role_table.end()) refuse(path, "the role " + exr::shown(name), exr::role_names());
  if (!passes.is_array()) {
    renderer.passes.push_back({role->role, names_of(passes, path)});
    return;
  }
  for (const json& pass : passes) renderer.passes.push_back({role->role, names_of(pass, path)});
}

}  // namespace

std::optional<exr::Renderer> read_renderer(const std::string& preset) {
  if (preset.empty() || preset == "auto" || exr::find_renderer(preset) != nullptr) return std::nullopt;
  if (!preset.ends_with(".json"))
    throw Error(ErrorCode::usage, "--preset", preset,
                "auto, " + exr::renderer_names() + ", or the name of a .json file");
  const json file = read_json("--preset", preset, "a JSON file with names of passes");
  exr::Renderer renderer{std::filesystem::path(preset).stem().string(), Lighting::raw, {}, {}};
  bool says_lighting = false;
  if (!file.is_object()) refuse(preset, printed(file), wanted_form);
  for (const auto& [key, value] : file.items()) {
    if (key == "lighting") {
      const auto lighting = value.is_string() ? value_named<Lighting>(value.get<std::string>()) : std::nullopt;
      if (!lighting) refuse(preset, "lighting " + printed(value), "raw or lit");
      renderer.lighting = *lighting;
      says_lighting = true;
    } else if (key == "roles" && value.is_object()) {
      for (const auto& [name, passes] : value.items()) add_role(renderer, name, passes, preset);
    } else {
      refuse(preset, exr::shown(key) + ": " + printed(value), wanted_form);
    }
  }
  if (renderer.passes.empty()) refuse(preset, "no roles", wanted_form);
  const bool has_light = std::any_of(renderer.passes.begin(), renderer.passes.end(),
                                     [](const exr::Renderer::Pass& pass) { return pass.role == exr::Role::light; });
  if (has_light && !says_lighting)
    refuse(preset, "no lighting", R"("lighting": "raw", or "lit" if the albedo is in the light)");
  return renderer;
}

}  // namespace dermis::program
