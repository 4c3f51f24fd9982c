/// The conditions under which a reader may trust a header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "exr/dwa_check.hpp"
#include "exr/header.hpp"

namespace dermis::exr {

/// Throws Error(input_unsupported).
[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view seen, std::string_view wanted);
[[noreturn]] void damaged(const std::filesystem::path& path, std::string_view what);

/// The first four bytes as a number.
std::uint32_t little_endian(std::string_view bytes);

/// False if the type of the attribute has a size and its value another.
bool has_right_size(const HeaderAttribute& attribute);

/// How the pixels of a part are cut into chunks, each of which is compressed by itself: some rows, or a tile.
struct ChunkGrid {
  std::uint64_t width;
  std::uint64_t height;
  std::int64_t first_row;  ///< of the data window
  std::uint64_t chunk_width;
  std::uint64_t chunk_height;
  std::vector<ChunkChannel> channels;
  std::uint8_t compression;  ///< as files number it
  bool has_tiles;
  std::uint64_t chunks_of_smaller_levels;  ///< of a mip map, which nobody reads

  std::uint64_t columns() const { return (width + chunk_width - 1) / chunk_width; }
  std::uint64_t pixel_bytes() const {
    std::uint64_t sum = 0;
    for (const ChunkChannel& channel : channels) sum += channel.bytes();
    return sum;
  }
  std::uint64_t rows() const { return (height + chunk_height - 1) / chunk_height; }
};

/// Bits of the flags of a file.
inline constexpr std::uint32_t tiled_flag = 0x200;
inline constexpr std::uint32_t deep_flag = 0x800;
inline constexpr std::uint32_t multi_part_flag = 0x1000;

/// The chunks of each part. Throws Error(input_unsupported) unless a file of these parts and so many bytes is flat,
/// within the limits, and can be complete.
std::vector<ChunkGrid> check_headers(const std::filesystem::path& path, const std::vector<Header>& parts,
                                     std::uint32_t flags, std::uint64_t file_bytes);

}  // namespace dermis::exr
