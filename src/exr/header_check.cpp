#include "exr/header_check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr std::uint32_t largest_tile_px = 8192;
constexpr std::uint64_t smallest_chunk_bytes = 16;  // its place in the table (8), its row (4), its size (4)

struct TypeSize {
  std::string_view type;
  std::size_t bytes;
};

/// OpenEXR reads values of these types without a look at the size that the file gives, so that a wrong one makes it
/// take the next bytes for anything, also for the size of an attribute of gigabytes.
constexpr std::array<TypeSize, 24> fixed_sizes = {{{"box2f", 16},
                                                   {"box2i", 16},
                                                   {"chromaticities", 32},
                                                   {"compression", 1},
                                                   {"deepImageState", 1},
                                                   {"double", 8},
                                                   {"envmap", 1},
                                                   {"float", 4},
                                                   {"int", 4},
                                                   {"keycode", 28},
                                                   {"lineOrder", 1},
                                                   {"m33d", 72},
                                                   {"m33f", 36},
                                                   {"m44d", 128},
                                                   {"m44f", 64},
                                                   {"rational", 8},
                                                   {"tiledesc", 9},
                                                   {"timecode", 8},
                                                   {"v2d", 16},
                                                   {"v2f", 8},
                                                   {"v2i", 8},
                                                   {"v3d", 24},
                                                   {"v3f", 12},
                                                   {"v3i", 12}}};

struct Box {
  std::int64_t y;
  std::int64_t width;
  std::int64_t height;
};

void check_channel_count(const std::filesystem::path& path, std::size_t channels) {
  if (channels == 0 || channels > static_cast<std::size_t>(max_channels))
    refuse(path, std::to_string(channels) + " channels", "1 to " + std::to_string(max_channels));
}

/// The facts of a header that decide how much memory a reader will ask for.
class HeaderCheck {
 public:
  HeaderCheck(const std::filesystem::path& path, const Header& attributes, std::uint32_t flags)
      : path_(path), attributes_(attributes), flags_(flags) {}

  ChunkGrid run() const {
    if (const HeaderAttribute* type = find("type"); type != nullptr && type->value.starts_with("deep")) {
      refuse(path_, "a deep picture", "a flat one");
    }
    box("displayWindow");
    std::vector<ChunkChannel> channels = channels_in_list();
    check_pixel_aspect();
    return grid_of(box("dataWindow"), std::move(channels));
  }

 private:
  const HeaderAttribute* find(std::string_view name) const {
    const auto it = std::find_if(attributes_.begin(), attributes_.end(),
                                 [name](const HeaderAttribute& attribute) { return attribute.name == name; });
    return it == attributes_.end() ? nullptr : &*it;
  }

  const std::string& value_of(std::string_view name, std::string_view type, std::size_t least_bytes) const {
    const HeaderAttribute* attribute = find(name);
    if (attribute == nullptr || attribute->type != type || attribute->value.size() < least_bytes) {
      damaged(path_, "no " + std::string(name));
    }
    return attribute->value;
  }

  Box box(std::string_view name) const {
    const std::string_view value = value_of(name, "box2i", 16);
    std::array<std::int64_t, 4> corner;
    for (std::size_t i = 0; i < 4; ++i) {
      corner[i] = std::bit_cast<std::int32_t>(little_endian(value.substr(4 * i)));
      if (std::abs(corner[i]) > max_coordinate) damaged(path_, std::string(name) + " at " + std::to_string(corner[i]));
    }
    const Box sides = {corner[1], corner[2] - corner[0] + 1, corner[3] - corner[1] + 1};
    if (std::min(sides.width, sides.height) < 1 || std::max(sides.width, sides.height) > max_side_px) {
      refuse(path_, std::string(name) + " of " + std::to_string(sides.width) + " x " + std::to_string(sides.height),
             "1 to " + std::to_string(max_side_px) + " pixels on a side");
    }
    return sides;
  }

  /// A channel list is, for each channel: name, 0, type (4), flags (4), sampling in x (4) and y (4); then a 0.
  std::vector<ChunkChannel> channels_in_list() const {
    std::string_view list = value_of("channels", "chlist", 1);
    std::set<std::string_view> names;
    std::vector<ChunkChannel> channels;
    while (!list.empty() && list[0] != '\0') {
      const std::size_t end = list.find('\0');
      if (end > max_name || list.size() < end + 17) damaged(path_, "channels");
      const std::string_view name = list.substr(0, end);
      if (!names.insert(name).second) damaged(path_, "channel " + escaped(name) + " twice");
      check_channel(name, list.substr(end + 1, 16));
      channels.push_back({std::string(name), little_endian(list.substr(end + 1))});
      list.remove_prefix(end + 17);
    }
    if (list.size() != 1) damaged(path_, "channels");
    check_channel_count(path_, channels.size());
    return channels;
  }

  void check_pixel_aspect() const {
    const HeaderAttribute* attribute = find("pixelAspectRatio");
    if (attribute == nullptr || attribute->type != "float" || attribute->value.size() < 4) return;
    const auto ratio = std::bit_cast<float>(little_endian(attribute->value));
    if (!(ratio >= 1e-6F && ratio <= 1e6F)) {  // what OpenEXR reads
      refuse(path_, "a pixelAspectRatio of " + std::to_string(ratio), "a pixelAspectRatio from 1e-6 to 1e6");
    }
  }

  void check_channel(std::string_view name, std::string_view facts) const {
    if (little_endian(facts) > 2) damaged(path_, "type of channel " + escaped(name));
    if (little_endian(facts.substr(8)) != 1 || little_endian(facts.substr(12)) != 1) {
      refuse(path_, "channel " + escaped(name) + " at a lower resolution", "all channels at one resolution");
    }
  }

  /// In files of several parts each says itself what it is, in others the flags do.
  bool has_tiles() const {
    if ((flags_ & multi_part_flag) == 0) return (flags_ & tiled_flag) != 0;
    return value_of("type", "string", 1) == "tiledimage";
  }

  ChunkGrid grid_of(const Box& data, std::vector<ChunkChannel> channels) const {
    const char compression = value_of("compression", "compression", 1)[0];
    ChunkGrid grid{.width = static_cast<std::uint64_t>(data.width),
                   .height = static_cast<std::uint64_t>(data.height),
                   .first_row = data.y,
                   .chunk_width = static_cast<std::uint64_t>(data.width),
                   .chunk_height = rows_of_chunk(compression),
                   .channels = std::move(channels),
                   .compression = static_cast<std::uint8_t>(compression),
                   .has_tiles = has_tiles(),
                   .chunks_of_smaller_levels = 0};
    if (!grid.has_tiles) return grid;
    const std::string_view tiles = value_of("tiles", "tiledesc", 9);
    grid.chunk_width = little_endian(tiles);
    grid.chunk_height = little_endian(tiles.substr(4));
    if (std::min(grid.chunk_width, grid.chunk_height) < 1 ||
        std::max(grid.chunk_width, grid.chunk_height) > largest_tile_px) {
      damaged(path_, "tiles of " + std::to_string(grid.chunk_width) + " x " + std::to_string(grid.chunk_height));
    }
    grid.chunks_of_smaller_levels = count_smaller_levels(grid, static_cast<unsigned char>(tiles[8]));
    return grid;
  }

  /// The low half of `mode` says how many levels there are (one, a mip map, or one of each width and height), the high
  /// half whether sides are rounded up where they are halved.
  std::uint64_t count_smaller_levels(const ChunkGrid& first, unsigned mode) const {
    enum : unsigned { one_level, mip_map, rip_map };
    const unsigned kind = mode & 0xF;
    if (kind > rip_map || mode >> 4 > 1) damaged(path_, "levels of tiles");
    if (kind == one_level) return 0;
    const std::vector<std::uint64_t> widths = sides_of_levels(first.width, mode >> 4);
    const std::vector<std::uint64_t> heights = sides_of_levels(first.height, mode >> 4);
    std::uint64_t chunks = 0;
    const auto add = [&](std::uint64_t width, std::uint64_t height) {
      ChunkGrid level = first;
      level.width = width;
      level.height = height;
      chunks += level.columns() * level.rows();
    };
    if (kind == mip_map) {
      for (std::size_t i = 1; i < std::max(widths.size(), heights.size()); ++i)
        add(i < widths.size() ? widths[i] : 1, i < heights.size() ? heights[i] : 1);
      return chunks;
    }
    for (const std::uint64_t height : heights)
      for (const std::uint64_t width : widths) add(width, height);
    return chunks - first.columns() * first.rows();
  }

  static std::vector<std::uint64_t> sides_of_levels(std::uint64_t side, std::uint64_t rounding) {
    std::vector<std::uint64_t> sides = {side};
    while (sides.back() > 1) sides.push_back((sides.back() + rounding) / 2);
    return sides;
  }

  std::uint64_t rows_of_chunk(char compression) const {
    // none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab
    constexpr std::array<std::uint64_t, 10> rows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    const auto index = static_cast<unsigned char>(compression);
    if (index >= rows.size()) refuse(path_, "compression " + std::to_string(index), "0 to 9");
    return rows[index];
  }

  const std::filesystem::path& path_;
  const Header& attributes_;
  std::uint32_t flags_;
};

}  // namespace

void refuse(const std::filesystem::path& path, std::string_view seen, std::string_view wanted) {
  throw Error(ErrorCode::input_unsupported, escaped(path.string()), seen, wanted);
}

void damaged(const std::filesystem::path& path, std::string_view what) {
  refuse(path, "a damaged header (" + std::string(what) + ")", "a complete OpenEXR file");
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return value;
}

bool has_right_size(const HeaderAttribute& attribute) {
  if (attribute.type == "preview") {
    const std::string_view value = attribute.value;
    if (value.size() < 8) return false;
    const std::uint64_t pixels = std::uint64_t{little_endian(value)} * little_endian(value.substr(4));
    return pixels <= value.size() && 4 * pixels == value.size() - 8;
  }
  const auto* const it = std::find_if(fixed_sizes.begin(), fixed_sizes.end(),
                                      [&attribute](const TypeSize& size) { return size.type == attribute.type; });
  return it == fixed_sizes.end() || it->bytes == attribute.value.size();
}

std::vector<ChunkGrid> check_headers(const std::filesystem::path& path, const std::vector<Header>& parts,
                                     std::uint32_t flags, std::uint64_t file_bytes) {
  std::vector<ChunkGrid> grids;
  std::uint64_t chunks = 0;
  std::size_t channels = 0;
  for (const Header& part : parts) {
    grids.push_back(HeaderCheck(path, part, flags).run());
    chunks += grids.back().columns() * grids.back().rows();
    channels += grids.back().channels.size();
  }
  check_channel_count(path, channels);
  if (file_bytes / smallest_chunk_bytes < chunks) {
    refuse(path, std::to_string(file_bytes) + " bytes for " + std::to_string(chunks) + " blocks of pixels",
           "a complete OpenEXR file");
  }
  return grids;
}

}  // namespace dermis::exr
