/// A picture that shows what became of the blocks of a frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/plan.hpp"

namespace dermis::program {

/// The word for a kind of block with blanks.
std::string in_words(std::string_view name);

/// The blocks of one kind, and how they are drawn.
struct KindShare {
  std::string name;
  std::string_view colour;
  std::array<float, 3> rgb;  ///< scene-linear
  std::int64_t blocks;
  double percent;
};

/// Of every kind, in their order.
std::vector<KindShare> shares_of(const TileMap& blocks);

/// A line per kind: its colour, how many blocks are of it, and their share.
std::string legend_of(const TileMap& blocks);

/// Every block in the colour of its kind, over the light of the frame, packed scene-linear RGB, from dim where it is
/// dark to full.
std::vector<float> tile_map(int width, int height, const TileMap& blocks, std::span<const float> light);

}  // namespace dermis::program
