/// --lights: lights, their shadow maps and the highlight, from a JSON file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/lights.hpp"
#include "dermis/shading.hpp"

namespace dermis::program {

/// The form of the file, for help texts.
inline constexpr std::string_view lights_grammar =
    "The file of lights is {\"lights\": [LIGHT, ...], \"highlight\": HIGHLIGHT}; what has a default here may be left "
    "out.\n"
    "Places and directions are in world space, lengths in scene units.\n"
    "LIGHT\n"
    "  \"kind\": \"directional\", \"point\" or \"spot\"\n"
    "  \"direction\": [x, y, z]      in which light travels; directional and spot\n"
    "  \"position\": [x, y, z]       point and spot; directional: where depths of a linear map begin ([0, 0, 0])\n"
    "  \"colour\": [r, g, b]         what a white surface facing it shows ([1, 1, 1])\n"
    "  \"attenuation\": [a, b, c]    at a distance d it is divided by a + b d + c d^2 ([0, 0, 1]); point and spot\n"
    "  \"cone_deg\": [inner, outer]  half angles between which it fades ([30, 45]); spot\n"
    "  \"shadow_map\": {             if it has one\n"
    "    \"file\": \"map.exr\"         beside the JSON file, unless the path is absolute\n"
    "    \"channel\": \"Depth.Z\"      which channel (the depth pass, or the only channel)\n"
    "    \"view_projection\": [[4 numbers], [...], [...], [...]]\n"
    "                              rows of the matrix from the world to the map: x / w from -1 at its left to 1 at "
    "its\n"
    "                              right, y / w from -1 at its lower to 1 at its upper edge\n"
    "    \"depth\": \"linear\"         scene units along the view axis, or \"projective\": z / w\n"
    "    \"bias\": 0                 scene units that a surface may lie deeper and still be lit\n"
    "  }\n"
    "HIGHLIGHT (of `dermis light` only)\n"
    "  \"roughness\": [m, ...]       of up to four lobes ([0.05, 0.1, 0.2, 0.3])\n"
    "  \"weight\": [w, ...]          as many ([0.1, 0.2, 0.3, 0.5])\n"
    "  \"reflectance\": f            of light head on (0.0278)";

/// Lights, and the memory of their maps.
class LightsFile {
 public:
  /// Reads the file and all maps. Throws Error(input_missing) if one is not there, Error(input_unsupported) that names
  /// the key, the value seen and the one wanted, Error(role_missing) if a map has no depth. `argument` is named.
  LightsFile(std::string_view argument, const std::string& path);

  /// The lights, with views of their maps.
  std::vector<Light> lights() const;

  /// The highlight of the file, in options that have their defaults else.
  const ShadingOptions& shading() const { return shading_; }

  /// The file itself and those of the maps.
  const std::vector<std::string>& files() const { return files_; }

 private:
  std::vector<std::string> files_;
  std::vector<Light> lights_;
  std::vector<std::vector<float>> maps_;  ///< one per light; empty if it has none
  ShadingOptions shading_;
};

/// The file of one light whose map is the file `map_name` beside it.
std::string lights_json(const Light& light, const std::string& map_name);

}  // namespace dermis::program
