#include "files/lights_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/message_text.hpp"
#include "files/input_file.hpp"
#include "report/json_text.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

constexpr std::array kind_names = {"directional", "point", "spot"};
constexpr std::array depth_names = {"linear", "projective"};

/// One object of the file and where it stands there.
class Object {
 public:
  Object(std::string file, std::string place, const json& value)
      : file_(std::move(file)), place_(std::move(place)), value_(value) {
    if (!value.is_object()) fail("", printed(value), "an object");
  }

  [[noreturn]] void fail(std::string_view key, std::string_view seen, std::string_view wanted) const {
    throw Error(ErrorCode::input_unsupported, fmt::format("{}: {}", file_, path_of(key)), seen, wanted);
  }

  /// A word that is misspelt would have its default.
  void allow(std::initializer_list<const char*> keys) const {
    for (const auto& [key, value] : value_.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        fail(key, "this key", fmt::format("one of {}", fmt::join(keys, ", ")));
    }
  }

  bool has(const char* key) const { return value_.contains(key); }

  const json& need(const char* key, std::string_view wanted) const {
    if (!has(key)) fail(key, "nothing", wanted);
    return value_[key];
  }

  Object object(const char* key) const { return {file_, path_of(key), need(key, "an object")}; }

  std::string text(const char* key, std::string_view wanted) const {
    const json& value = need(key, wanted);
    if (!value.is_string()) fail(key, printed(value), wanted);
    return value.get<std::string>();
  }

  /// The number of the word among `words`.
  template <std::size_t N>
  int word(const char* key, const std::array<const char*, N>& words) const {
    const std::string wanted = fmt::format("{}", fmt::join(words, " or "));
    const std::string seen = text(key, wanted);
    const auto found = std::find(words.begin(), words.end(), seen);
    if (found == words.end()) fail(key, printed(value_[key]), wanted);
    return static_cast<int>(found - words.begin());
  }

  double number(const char* key, double otherwise) const {
    return has(key) ? number_in(key, value_[key], "a finite number") : otherwise;
  }

  std::vector<double> numbers(const char* key, std::string_view wanted) const {
    const json& values = need(key, wanted);
    if (!values.is_array()) fail(key, printed(values), wanted);
    std::vector<double> all;
    for (const json& value : values) all.push_back(number_in(key, value, wanted));
    return all;
  }

  template <std::size_t N>
  std::array<double, N> numbers_of(const char* key, std::string_view wanted) const {
    const std::vector<double> all = numbers(key, wanted);
    if (all.size() != N) fail(key, printed(value_[key]), wanted);
    std::array<double, N> result{};
    std::copy(all.begin(), all.end(), result.begin());
    return result;
  }

  std::array<double, 3> triple(const char* key) const { return numbers_of<3>(key, "three finite numbers"); }
  std::array<double, 3> triple(const char* key, const std::array<double, 3>& otherwise) const {
    return has(key) ? triple(key) : otherwise;
  }

  std::array<double, 16> matrix(const char* key) const {
    constexpr std::string_view wanted = "four rows of four finite numbers";
    const json& rows = need(key, wanted);
    if (!rows.is_array() || rows.size() != 4) fail(key, printed(rows), wanted);
    std::array<double, 16> result{};
    std::size_t at = 0;
    for (const json& row : rows) {
      if (!row.is_array() || row.size() != 4) fail(key, printed(row), wanted);
      for (const json& value : row) result[at++] = number_in(key, value, wanted);
    }
    return result;
  }

 private:
  std::string path_of(std::string_view key) const {
    return fmt::format("{}{}{}", place_, place_.empty() || key.empty() ? "" : ".", exr::shown(key));
  }

  double number_in(const char* key, const json& value, std::string_view wanted) const {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!std::isfinite(number)) fail(key, printed(value), wanted);
    return number;
  }

  std::string file_;
  std::string place_;
  const json& value_;
};

/// The depths of a map: of the channel that is named, of the depth pass, or of the only channel.
std::vector<float> depths_of(const Object& map, const exr::Picture& picture) {
  if (map.has("channel")) return picture.plane(map.text("channel", "the name of a channel"));
  if (picture.channels().size() == 1) return picture.plane(picture.channels()[0].name);
  const exr::Roles roles = exr::find_roles(picture);
  exr::require(picture, roles, exr::Role::depth);
  return exr::load(picture, roles, exr::Role::depth);
}

/// Returns the file of the map.
std::string read_map(const Object& object, const std::filesystem::path& folder, Light& light,
                     std::vector<float>& depths) {
  object.allow({"file", "channel", "view_projection", "depth", "bias"});
  constexpr const char* wanted = "the name of an OpenEXR file";
  const std::string name = object.text("file", wanted);
  if (name.find('\0') != std::string::npos) object.fail("file", exr::shown(name), wanted);
  const std::filesystem::path path = folder / name;
  const exr::Picture picture = exr::Picture::read(path);
  depths = depths_of(object, picture);
  light.map.width = picture.width();
  light.map.height = picture.height();
  light.map.view_projection = object.matrix("view_projection");
  if (object.has("depth")) light.map.kind = static_cast<MapDepth>(object.word("depth", depth_names));
  light.map.bias_units = object.number("bias", 0);
  if (light.map.bias_units < 0) object.fail("bias", fmt::format("{}", light.map.bias_units), "0 or more");
  return path.string();
}

Light read_light(const Object& object) {
  object.allow({"kind", "direction", "position", "colour", "attenuation", "cone_deg", "shadow_map"});
  Light light;
  light.kind = static_cast<Light::Kind>(object.word("kind", kind_names));
  const bool is_directional = light.kind == Light::Kind::directional;
  if (light.kind != Light::Kind::point) light.direction = object.triple("direction");
  light.position = is_directional ? object.triple("position", light.position) : object.triple("position");
  light.colour = object.triple("colour", light.colour);
  light.attenuation = object.triple("attenuation", light.attenuation);
  if (object.has("cone_deg")) {
    const auto cone = object.numbers_of<2>("cone_deg", "two angles in degrees");
    light.cone_inner_deg = cone[0];
    light.cone_outer_deg = cone[1];
  }
  return light;
}

ShadingOptions read_highlight(const Object& object) {
  object.allow({"roughness", "weight", "reflectance"});
  ShadingOptions options;
  options.reflectance = object.number("reflectance", options.reflectance);
  if (object.has("roughness") || object.has("weight")) {
    const std::vector<double> roughness = object.numbers("roughness", "numbers from 0.02 to 1");
    const std::vector<double> weight = object.numbers("weight", "as many numbers as roughness has");
    if (weight.size() != roughness.size())
      object.fail("weight", fmt::format("{} numbers", weight.size()), fmt::format("{}", roughness.size()));
    options.lobes.clear();
    for (std::size_t i = 0; i < weight.size(); ++i) options.lobes.push_back({roughness[i], weight[i]});
  }
  return options;
}

}  // namespace

LightsFile::LightsFile(std::string_view argument, const std::string& path) : files_{path} {
  const json root = read_json(argument, path, "a JSON file with lights");
  const std::string name = fmt::format("{} {}", argument, path);
  const Object all(name, "", root);
  all.allow({"lights", "highlight"});
  const json& list = all.need("lights", "a list of lights");
  if (!list.is_array() || list.empty()) all.fail("lights", printed(list), "a list of lights, one at least");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const json& entry : list) {
    const Object object(name, fmt::format("lights[{}]", lights_.size()), entry);
    lights_.push_back(read_light(object));
    maps_.emplace_back();
    if (object.has("shadow_map"))
      files_.push_back(read_map(object.object("shadow_map"), folder, lights_.back(), maps_.back()));
  }
  if (all.has("highlight")) shading_ = read_highlight(all.object("highlight"));
}

std::vector<Light> LightsFile::lights() const {
  std::vector<Light> all = lights_;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!maps_[i].empty()) all[i].map.depth = {.host = maps_[i].data()};
  return all;
}

std::string lights_json(const Light& light, const std::string& map_name) {
  json rows = json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back(std::vector<double>(light.map.view_projection.begin() + 4 * row,
                                       light.map.view_projection.begin() + 4 * row + 4));
  const json its = {{"kind", kind_names[static_cast<std::size_t>(light.kind)]},
                    {"direction", light.direction},
                    {"position", light.position},
                    {"colour", light.colour},
                    {"shadow_map",
                     {{"file", map_name},
                      {"view_projection", rows},
                      {"depth", depth_names[static_cast<std::size_t>(light.map.kind)]},
                      {"bias", light.map.bias_units}}}};
  return json_text(json{{"lights", {its}}});
}

}  // namespace dermis::program
