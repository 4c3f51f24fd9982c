#include "report/tile_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "files/picture_png.hpp"

namespace dermis::program {
namespace {

struct KindLook {
  std::string_view colour;
  std::array<float, 3> rgb;  ///< scene-linear
};

/// The looks stand in the order of TileKind. Tiles that are skipped are cold or grey, those that are filtered are warm;
/// people who do not see red and green apart can tell these hues apart, too.
constexpr std::array<KindLook, word_table<TileKind>.size()> looks = {{{"grey", {0.5F, 0.5F, 0.5F}},
                                                                      {"cyan", {0, 0.8F, 0.8F}},
                                                                      {"blue", {0, 0.1F, 1}},
                                                                      {"green", {0, 0.5F, 0.1F}},
                                                                      {"yellow", {1, 0.8F, 0}},
                                                                      {"red", {1, 0.05F, 0.02F}},
                                                                      {"white", {1, 1, 1}}}};

const KindLook& look_of(TileKind kind) { return looks[static_cast<std::size_t>(kind)]; }

/// 0..1, half way for light of 1/5, so that dark surfaces show.
float brightness(const float* rgb) {
  const float light = 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
  return light > 0 ? std::sqrt(light / (light + 0.6F)) : 0;
}

}  // namespace

std::string in_words(std::string_view name) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string legend_of(const TileMap& tiles) {
  std::string text =
      fmt::format("tile map    {} tiles of {}x{} pixels\n", tiles.kinds.size(), tiles.tile_width, tiles.tile_height);
  for (const auto& [kind, name] : word_table<TileKind>) {
    const auto count = std::count(tiles.kinds.begin(), tiles.kinds.end(), kind);
    const double share = 100 * static_cast<double>(count) / static_cast<double>(tiles.kinds.size());
    text += fmt::format("  {:<18}{:<8}{:>6}  {:5.1f} %\n", in_words(name), look_of(kind).colour, count, share);
  }
  return text;
}

std::string tile_map_png(int width, int height, const TileMap& tiles, std::span<const float> light) {
  constexpr float darkest = 0.15F;
  std::vector<float> rgb;
  rgb.reserve(light.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x;
      const auto tile = static_cast<std::size_t>(y / tiles.tile_height) * static_cast<std::size_t>(tiles.columns) +
                        x / tiles.tile_width;
      const float shade = darkest + (1 - darkest) * brightness(&light[3 * pixel]);
      for (const float channel : look_of(tiles.kinds[tile]).rgb) rgb.push_back(shade * channel);
    }
  }
  return srgb_png(width, height, rgb);
}

}  // namespace dermis::program
