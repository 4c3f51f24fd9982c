/// A picture that shows what became of the tiles of a frame.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "dermis/plan.hpp"

namespace dermis::program {

/// The word for a kind of tile with blanks.
std::string in_words(std::string_view name);

/// A line per kind: its colour, how many tiles are of it, and their share.
std::string legend_of(const TileMap& tiles);

/// The PNG file of every tile in the colour of its kind, over the light of the frame, packed scene-linear RGB, from dim
/// where it is dark to full. Throws Error(output).
std::string tile_map_png(int width, int height, const TileMap& tiles, std::span<const float> light);

}  // namespace dermis::program
