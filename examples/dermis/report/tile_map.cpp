#include "report/tile_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace dermis::program {
namespace {

struct KindLook {
  std::string_view colour;
  std::array<float, 3> rgb;  ///< scene-linear
};

/// The looks stand in the order of TileKind. Blocks that are skipped are cold or grey, those that are filtered are
/// warm; people who do not see red and green apart can tell these hues apart, too.
constexpr std::array<KindLook, word_table<TileKind>.size()> looks = {{{"grey", {0.5F, 0.5F, 0.5F}},
                                                                      {"cyan", {0, 0.8F, 0.8F}},
                                                                      {"blue", {0, 0.1F, 1}},
                                                                      {"green", {0, 0.5F, 0.1F}},
                                                                      {"yellow", {1, 0.8F, 0}},
                                                                      {"red", {1, 0.05F, 0.02F}},
                                                                      {"white", {1, 1, 1}},
                                                                      {"magenta", {0.8F, 0, 0.6F}}}};

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

std::vector<KindShare> shares_of(const TileMap& blocks) {
  std::vector<KindShare> shares;
  for (const auto& [kind, name] : word_table<TileKind>) {
    const auto& [colour, rgb] = look_of(kind);
    const std::int64_t count = blocks.count(kind);
    shares.push_back({in_words(name), colour, rgb, count,
                      100 * static_cast<double>(count) / static_cast<double>(blocks.kinds.size())});
  }
  return shares;
}

std::string legend_of(const TileMap& blocks) {
  std::string text = fmt::format("tile map    {} blocks of {}x{} pixels\n", blocks.kinds.size(), blocks.tile_width,
                                 blocks.tile_height);
  for (const KindShare& its : shares_of(blocks))
    text += fmt::format("  {:<18}{:<8}{:>6}  {:5.1f} %\n", its.name, its.colour, its.blocks, its.percent);
  return text;
}

std::vector<float> tile_map(int width, int height, const TileMap& blocks, std::span<const float> light) {
  constexpr float darkest = 0.15F;
  std::vector<float> rgb;
  rgb.reserve(light.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x;
      const auto block = static_cast<std::size_t>(y / blocks.tile_height) * static_cast<std::size_t>(blocks.columns) +
                         x / blocks.tile_width;
      const float shade = darkest + (1 - darkest) * brightness(&light[3 * pixel]);
      for (const float channel : look_of(blocks.kinds[block]).rgb) rgb.push_back(shade * channel);
    }
  }
  return rgb;
}

}  // namespace dermis::program
