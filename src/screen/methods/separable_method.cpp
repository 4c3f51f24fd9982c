#include "screen/methods/separable_method.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

#include "dermis/tap_tables.hpp"

namespace dermis {

namespace {

/// Tables one after the other, each aligned as a buffer of its own would be.
class PackedTables {
 public:
  template <class Row>
  params::Bytes add(const std::vector<Row>& rows) {
    constexpr std::size_t alignment = 128;
    bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
    const std::size_t begin = bytes_.size();
    const auto* first = reinterpret_cast<const std::byte*>(rows.data());
    bytes_.insert(bytes_.end(), first, first + rows.size() * sizeof(Row));
    return static_cast<params::Bytes>(begin);
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

TileKind kind_of(const params::BlockPasses& block) {
  const auto& [x, y] = block;
  if (x.block_class == CLASS_EMPTY) return TileKind::without_material;
  if (x.px_per_mm == 0) return TileKind::narrow;
  if (x.material == 0 || y.material == 0) return TileKind::mixed;
  return x.block_class == CLASS_FLAT && y.block_class == CLASS_FLAT ? TileKind::flat : TileKind::curved;
}

}  // namespace

void SeparableMethod::measure(const MaterialTables& tables) {
  terms_ = tables.terms_per_material;
  farthest_px_ = tables.farthest_px;
  for (const params::MaterialParams& its : tables.materials) {
    Reach reach{its.radius_mm, {}};
    for (int i = 0; i < its.levels; ++i) {
      const int last_px = tables.levels[its.first_level + i].last_offset_px;
      reach.last_px.push_back(std::max(last_px, reach.last_px.empty() ? 0 : reach.last_px.back()));
    }
    reaches_.push_back(std::move(reach));
  }
}

int SeparableMethod::farthest_tap_px(double px_per_mm) const {
  int farthest = 0;
  for (const Reach& its : reaches_) {
    const int level = Taps::level_index(static_cast<float>(px_per_mm * its.radius_mm));
    if (level < 0 || its.last_px.empty()) continue;
    // A flat block takes the nearest level instead of the one below.
    const auto index = std::min(static_cast<std::size_t>(level) + 1, its.last_px.size() - 1);
    farthest = std::max(farthest, its.last_px[index]);
  }
  return farthest;
}

int SeparableMethod::reach_rows(const Finest& finest, const Camera& camera, const FrameSize& frame) const {
  // A slanted surface has more pixels per mm than the one that faces the camera: by up to the length of the ray.
  const double most_per_mm = 1.01 * longest_ray(camera, frame);
  const int along_y = farthest_tap_px(most_per_mm * finest.y);
  if (settings_.options.jitter == 0) {
    // The class of a block is that of the surface within 9/8 of its taps, and slopes are taken from the next row.
    return rows_within(std::max(1.0 * along_y, 1.125 * farthest_tap_px(finest.y)) + 1, frame);
  }
  const double turn = std::max({1.0, camera.scale_y / camera.scale_x, camera.scale_x / camera.scale_y});
  const int along_x = farthest_tap_px(most_per_mm * finest.x);
  return rows_within(turn * (along_x + along_y) + 4,
                     frame);  // a tap of the vertical pass, turned, and one of that pixel
}

void SeparableMethod::upload(const cl::Context& context, const MaterialTables& tables) {
  PackedTables packed;
  taps_at_.terms = packed.add(tables.terms);
  taps_at_.offsets = packed.add(tables.offsets_px);
  taps_at_.nearness = packed.add(tables.nearness);
  taps_at_.weights = packed.add(tables.weights);
  taps_at_.flat_weights = packed.add(tables.flat_weights);
  taps_ = dermis::upload(context, packed.bytes());
}

void SeparableMethod::add_to(Stats& stats, const FrameRun& run) const {
  const RowRange rows = run.own_rows();
  TileMap& map = stats.blocks;
  map = {BLOCK, BLOCK, run.frame().blocks_x, parts_of(rows.count, BLOCK), {}};
  std::vector<params::BlockPasses> passes(static_cast<std::size_t>(map.columns) * map.rows);
  constexpr std::size_t bytes = sizeof(params::BlockPasses);
  run.queue().enqueueReadBuffer(run.memory().passes, CL_TRUE,
                                static_cast<std::size_t>(map.columns) * (rows.first / BLOCK) * bytes,
                                passes.size() * bytes, passes.data());
  std::transform(passes.begin(), passes.end(), std::back_inserter(map.kinds), kind_of);
}

cl::Buffer SeparableMethod::rotations(const FrameRun& run) const {
  if (settings_.options.jitter == 0) return taps_;
  // In whole 1/4096 px, so that every device rounds alike. Lengths in mm are kept where pixels are not square.
  constexpr double one = 4096;
  const Camera& camera = run.camera();
  std::vector<params::RotationParams> table;
  for (int i = 0; i < ROTATIONS; ++i) {
    const double angle = 2 * std::numbers::pi * i / ROTATIONS;
    table.push_back({static_cast<int>(std::lround(one * std::cos(angle))),
                     static_cast<int>(std::lround(one * std::sin(angle) * camera.scale_y / camera.scale_x)),
                     static_cast<int>(std::lround(-one * std::sin(angle) * camera.scale_x / camera.scale_y)), 0});
  }
  return dermis::upload(run.context(), table);
}

}  // namespace dermis
