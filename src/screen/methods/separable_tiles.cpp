// The separable passes tile by tile, for CPUs: the windows of a tile stay in the cache of a core. The kernels are in
// kernels/separable/tile.cl.
#include <algorithm>
#include <bit>

#include "opencl/program.hpp"
#include "screen/methods/scatter_methods.hpp"
#include "screen/methods/separable_method.hpp"
#include "screen/methods/window_layout.hpp"

namespace dermis {

namespace {

/// The buffers of a run.
enum Buffer { windows, kinds };

/// Elements of a plane: a multiple of 64, so that the bytes after planes of floats align, too.
std::size_t aligned(std::size_t elements) { return (elements + 63) / 64 * 64; }

/// The rows of a ring buffer: rows_mask of tile_windows.h.
std::size_t ring_rows(std::size_t rows, int frame_rows) {
  return std::min<std::size_t>(frame_rows, std::bit_ceil(std::min<std::size_t>(frame_rows, rows)));
}

/// Blocks that were skipped with the tile that holds their first pixel.
void skip_blocks(TileMap& blocks, const TileMap& tiles) {
  using enum TileKind;
  for (int y = 0; y < blocks.rows; ++y) {
    for (int x = 0; x < blocks.columns; ++x) {
      const int tile = y * BLOCK / tiles.tile_height * tiles.columns + x * BLOCK / tiles.tile_width;
      const TileKind kind = tiles.kinds[tile];
      TileKind& block = blocks.kinds[static_cast<std::size_t>(y) * blocks.columns + x];
      if (block != without_material && (kind == unlit || kind == uniform || kind == reused)) block = kind;
    }
  }
}

class SeparableTiles final : public SeparableMethod {
 public:
  using SeparableMethod::SeparableMethod;

  ProgramSource kernels(int terms) const override { return {{"separable/tile.cl"}, build_constant("TERMS", terms)}; }

  std::vector<BufferSize> buffers(const FrameSize& frame) const override {
    const params::TileParams tile = tiles(frame);
    const std::size_t most_tiles = static_cast<std::size_t>(tile.columns) * parts_of(frame.height, tile.least_height);
    return {{"windows of tiles", tile.workers * static_cast<std::size_t>(worker_memory(frame).bytes)},
            {"kinds of tiles", most_tiles}};
  }

  void prepare(FrameRun& run) const override { run.compare_with_frame_before(); }

  void scatter(FrameRun& run, RowRange) const override {
    using enum ImageName;
    const RunMemory& memory = run.memory();
    const params::TileParams tile = tiles(run.size());
    const cl::Buffer axes = rotations(run);  // a kernel does not keep its arguments before it is launched
    cl::Kernel kernel(run.program(), "scatter");
    set_arguments(kernel, run.frame(), run.input_layouts(),
                  run.inputs({light, albedo, depth, mask, matte, beauty, scattered, result}), run.flags(),
                  run.materials(), run.levels(), taps_at_, taps_, axes, settings_.options.seed, memory.material_ids,
                  memory.blocks, memory.passes, tile, worker_memory(run.size()), memory.method[windows], run.changed(),
                  run.deferred(), memory.method[kinds], memory.counters);
    // A device may give a thread several work-items in one go.
    constexpr int items_per_worker = 8;
    run.launch(kernel, items_per_worker * tile.workers, 1, 1);
  }

  void finish(FrameRun& run) const override {
    if (run.flags().defers != 0) run.write_deferred(tiles(run.size()), run.memory().method[kinds]);
  }

  void add_to(Stats& stats, const FrameRun& run) const override {
    const params::TileParams tile = tiles(run.size());
    const int tile_height = run.counters()[COUNTER_TILE_HEIGHT];
    TileMap& map = stats.tiles;
    map = {tile.width, tile_height, tile.columns, parts_of(run.own_rows().count, tile_height), {}};
    map.kinds.resize(static_cast<std::size_t>(map.columns) * map.rows);
    run.queue().enqueueReadBuffer(run.memory().method[kinds], CL_TRUE, 0, map.kinds.size(), map.kinds.data());
    SeparableMethod::add_to(stats, run);
    skip_blocks(stats.blocks, map);
  }

  bool by_tiles() const override { return true; }

 private:
  params::TileParams tiles(const FrameSize& frame) const {
    constexpr int usual_width_px = 240;
    constexpr int most_height_px = 512;
    constexpr int most_height_of_rotated_px = 256;  // memory grows with it
    constexpr int least_height_px = 32;
    const Options& options = settings_.options;
    params::TileParams tiles{};
    tiles.width = options.tile_width > 0 ? options.tile_width : usual_width_px;
    tiles.height = tiles.least_height = options.tile_height;
    if (options.tile_height == 0) {
      tiles.height = options.jitter > 0 ? most_height_of_rotated_px : most_height_px;
      tiles.least_height = least_height_px;
    }
    tiles.columns = parts_of(frame.width, tiles.width);
    tiles.rows = parts_of(frame.height, tiles.height);
    tiles.workers = std::max(1, settings_.device.info().compute_units);
    return tiles;
  }

  params::TileMemory worker_memory(const FrameSize& frame) const {
    const params::TileParams tile = tiles(frame);
    const bool turns_taps = settings_.options.jitter > 0;
    const bool has_pixel_width = settings_.has_pixel_width();
    const auto reach = static_cast<std::size_t>(farthest_px_);
    const int side_px = settings_.is_sheared() ? round_up(MOST_FLAT_SIDE, BLOCK) : 0;
    const auto columns = [&](std::size_t own, std::size_t around) {
      return std::min<std::size_t>(frame.stride(), own + 2 * (around + PADDING));
    };
    std::size_t horizontal_plane = 0;
    std::size_t vertical_plane = 0;
    if (turns_taps) {
      // Rotated taps leave the axes: the horizontal pass needs the surroundings of the surroundings, in all rows.
      const std::size_t horizontal_reach = 4 * reach + 4;
      const std::size_t vertical_reach = 2 * reach + 2;
      horizontal_plane =
          columns(tile.width, horizontal_reach + BLOCK) * ring_rows(tile.height + 2 * horizontal_reach, frame.height);
      vertical_plane = (columns(round_up(tile.width, BLOCK), vertical_reach + BLOCK) + BLOCK) *
                       ring_rows(tile.height + 2 * vertical_reach, frame.height);
    } else {
      // The horizontal pass needs one row at a time, the vertical one those that taps of a strip fall on.
      horizontal_plane = columns(tile.width, reach + side_px + BLOCK);
      vertical_plane = (columns(round_up(tile.width, BLOCK), side_px) + BLOCK) *
                       ring_rows(2 * (reach + 2) + STRIP_ROWS + 3, frame.height);
    }
    horizontal_plane = aligned(horizontal_plane);
    vertical_plane = aligned(vertical_plane);

    params::TileMemory memory{};
    memory.horizontal = window_layout(horizontal_plane, 1, has_pixel_width);
    memory.vertical = window_layout(vertical_plane, terms_, has_pixel_width);
    std::size_t end = 0;
    const auto append = [&](std::size_t bytes) {
      const auto begin = static_cast<params::Bytes>(end);
      end += bytes;
      return begin;
    };
    append(window_bytes(memory.horizontal));
    memory.vertical_window = append(window_bytes(memory.vertical));
    memory.strip = append(static_cast<std::size_t>(round_up(tile.width, BLOCK)) * 3 * STRIP_ROWS * sizeof(float));
    memory.choices = append(horizontal_plane / BLOCK * sizeof(params::ChoiceParams));
    // The rows of the ring are longer than 8 elements each, and there are fewer pairs of taps, with two sides each,
    // than rows that they reach.
    memory.row_at = append(vertical_plane / 8 * sizeof(int));
    memory.side_at = append(vertical_plane / 8 * sizeof(int));
    memory.bytes = static_cast<params::Bytes>(end);
    return memory;
  }
};

}  // namespace

std::unique_ptr<ScatterMethod> make_separable_tiles(const PlanSettings& settings) {
  return std::make_unique<SeparableTiles>(settings);
}

}  // namespace dermis
