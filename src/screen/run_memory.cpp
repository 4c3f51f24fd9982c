#include "screen/run_memory.hpp"

#include <algorithm>
#include <bit>

namespace dermis {

namespace {

int round_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

int parts(int whole, int part) { return (whole + part - 1) / part; }

constexpr std::size_t alignment = 64;  ///< elements of a plane, so that the bytes after planes of floats align too

std::size_t aligned(std::size_t elements) { return (elements + alignment - 1) / alignment * alignment; }

/// window_bytes of window.h.
std::size_t window_bytes(std::size_t plane, int images, bool has_pixel_width) {
  const std::size_t planes = 3 * static_cast<std::size_t>(images) + 2 + (has_pixel_width ? 3 : 0);
  return plane * (planes * sizeof(float) + 2);
}

}  // namespace

int RunSizes::stride() const { return round_up(width, BLOCK) + 2 * PADDING; }
int RunSizes::blocks_x() const { return parts(width, BLOCK); }
int RunSizes::blocks_y() const { return parts(height, BLOCK); }
int RunSizes::tiles_x() const { return parts(width, tile_width); }
int RunSizes::tiles_y(int its_tile_height) const { return parts(height, its_tile_height); }

std::size_t RunSizes::frame_plane() const { return static_cast<std::size_t>(stride()) * height; }

std::size_t RunSizes::horizontal_plane() const {
  if (workers == 0) return frame_plane();
  // Taps that are turned need the surroundings of the surroundings.
  const std::size_t reach = static_cast<std::size_t>(farthest_px) * (turns_taps ? 4 : 1) + (turns_taps ? 4 : 0);
  const std::size_t columns =
      std::min<std::size_t>(stride(), tile_width + 2 * (reach + round_up(side_px, BLOCK) + BLOCK + PADDING));
  const std::size_t rows = turns_taps ? std::bit_ceil(std::min<std::size_t>(height, tile_height + 2 * reach)) : 1;
  return aligned(columns * rows);
}

std::size_t RunSizes::vertical_plane() const {
  if (workers == 0) return 0;
  const std::size_t reach = static_cast<std::size_t>(farthest_px) * (turns_taps ? 2 : 1) + 2;
  const std::size_t turned = turns_taps ? reach + BLOCK : round_up(side_px, BLOCK);
  const std::size_t columns =
      std::min<std::size_t>(stride(), round_up(tile_width, BLOCK) + 2 * (turned + PADDING)) + BLOCK;
  // Without turned taps a row is not needed any more when the vertical pass is beyond it.
  constexpr std::size_t strip_rows = STRIP_ROWS + 3;
  const std::size_t needed =
      std::min<std::size_t>(height, turns_taps ? tile_height + 2 * reach : 2 * reach + strip_rows);
  // rows_mask of tile_windows.h
  const std::size_t rows = std::min<std::size_t>(height, std::bit_ceil(needed));
  return aligned(columns * rows);
}

std::size_t RunSizes::windows_bytes() const {
  if (workers == 0) return window_bytes(horizontal_plane(), 1, has_pixel_width);
  const std::size_t strip_bytes =
      static_cast<std::size_t>(round_up(tile_width, BLOCK)) * 3 * STRIP_ROWS * sizeof(float);
  return workers * (window_bytes(horizontal_plane(), 1, has_pixel_width) +
                    window_bytes(vertical_plane(), terms, has_pixel_width) + strip_bytes +
                    horizontal_plane() / BLOCK * sizeof(params::ChoiceParams) + vertical_plane());
}

params::TexelLevels RunSizes::levels() const {
  params::TexelLevels levels{};
  std::size_t texels = 0;
  while (levels.count < texel_levels && (width >> levels.count) > 0 && (height >> levels.count) > 0) {
    levels.first[levels.count] = static_cast<params::Bytes>(texels);
    texels += static_cast<std::size_t>(width >> levels.count) * (height >> levels.count);
    ++levels.count;
  }
  levels.texels = static_cast<params::Bytes>(texels);
  return levels;
}

std::size_t RunSizes::between_bytes() const {
  if (method == Method::disc) return static_cast<std::size_t>(levels().texels) * sizeof(params::TexelParams);
  return 3 * static_cast<std::size_t>(method == Method::exact ? 1 : terms) * frame_plane() * sizeof(float);
}

std::size_t RunSizes::segments_bytes() const {
  if (method == Method::disc) return 2 * static_cast<std::size_t>(blocks_x()) * blocks_y();
  return method == Method::exact ? 0 : frame_plane() * sizeof(float);
}

std::size_t RunSizes::deferred_bytes() const { return 3 * frame_plane() * sizeof(float); }

std::size_t RunSizes::bytes(bool defers) const {
  const std::size_t blocks = static_cast<std::size_t>(blocks_x()) * blocks_y();
  const std::size_t tiles = static_cast<std::size_t>(tiles_x()) * tiles_y(least_tile_height);
  std::size_t sum =
      frame_plane() + blocks * (sizeof(params::BlockParams) + sizeof(params::BlockPasses)) + windows_bytes() + tiles;
  if (workers == 0) sum += between_bytes() + segments_bytes();
  if (defers || workers == 0) sum += deferred_bytes();
  return sum;
}

RunMemory::RunMemory(const cl::Context& context, const RunSizes& wanted) : sizes(wanted) {
  const auto allocate = [&](std::size_t bytes) { return cl::Buffer(context, CL_MEM_READ_WRITE, bytes); };
  const std::size_t block_count = static_cast<std::size_t>(sizes.blocks_x()) * sizes.blocks_y();
  material_ids = allocate(sizes.frame_plane());
  blocks = allocate(block_count * sizeof(params::BlockParams));
  passes = allocate(block_count * sizeof(params::BlockPasses));
  windows = allocate(sizes.windows_bytes());
  kinds = allocate(static_cast<std::size_t>(sizes.tiles_x()) * sizes.tiles_y(sizes.least_tile_height));
  counters = allocate(RUN_COUNTERS * sizeof(cl_int));
  between = kinds;
  segments = kinds;
  deferred = kinds;
  if (sizes.workers > 0) return;
  deferred = allocate(sizes.deferred_bytes());
  between = allocate(sizes.between_bytes());
  if (sizes.segments_bytes() > 0) segments = allocate(sizes.segments_bytes());
}

void RunMemory::need_deferred(const cl::Context& context) {
  if (deferred() == kinds()) deferred = cl::Buffer(context, CL_MEM_READ_WRITE, sizes.deferred_bytes());
}

}  // namespace dermis
