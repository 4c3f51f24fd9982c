#include "oracle/classify/block.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "oracle/classify/tap_level.hpp"

namespace dermis::oracle {

namespace {

int blocks_over(int size_px) { return (size_px + block_px - 1) / block_px; }

/// Two more roundings cover any order of the sum, and factors taken out of it.
Bounded squared_length(const Tangent& v) { return rounded(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 2); }

}  // namespace

void Blocks::Range::add(Bounded value) {
  low_ = std::min(low_, value.value);
  high_ = std::max(high_, value.value);
  error_ = std::max(error_, value.error);
}

void Blocks::Range::add(const Range& other) {
  low_ = std::min(low_, other.low_);
  high_ = std::max(high_, other.high_);
  error_ = std::max(error_, other.error_);
}

// Halving does not round.
Bounded Blocks::Range::middle() const { return low_ <= high_ ? rounded({(low_ + high_) / 2, error_}) : exact(0); }

Bounded Blocks::Range::half_range() const { return low_ <= high_ ? rounded({(high_ - low_) / 2, error_}) : exact(0); }

// The maximum over what surely counts is a device's lower bound, that over what may count the upper.
void Blocks::Largest::add(Bounded value, bool counts, bool unsure) {
  if (counts) nominal_ = std::max(nominal_, value.value);
  if (counts && !unsure) low_ = std::max(low_, value.low());
  if (counts || unsure) high_ = std::max(high_, value.high());
}

Blocks::Blocks(const Surface& surface, std::span<const Material> materials, bool may_be_flat)
    : surface_(surface),
      materials_(materials),
      may_be_flat_(may_be_flat),
      columns_(blocks_over(surface.width())),
      rows_(blocks_over(surface.height())),
      blocks_(static_cast<std::size_t>(columns_) * rows_) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Block& block = blocks_[static_cast<std::size_t>(row) * columns_ + column];
      for_each_pixel(column, row, [&](int x, int y) { add_pixel(block, x, y); });
    }
  }
}

void Blocks::add_pixel(Block& block, int x, int y) const {
  const SurfacePixel& pixel = surface_.at(x, y);
  if (pixel.material < 0) return;
  if (pixel.wide) block.scatters.set(pixel.material);
  if (pixel.wide && !pixel.wide_unsure) block.surely_scatters.set(pixel.material);
  if (pixel.wide || pixel.wide_unsure) block.perhaps_scatters.set(pixel.material);
  block.is_partial = block.is_partial || pixel.covered < 1;
  block.depth_mm.add(pixel.position_mm[2]);
  for (const Axis axis : {horizontal, vertical}) {
    block.px_per_mm[axis].add(pixel.effective_px_per_mm[axis], pixel.wide, pixel.wide_unsure);
    const int next_x = axis == horizontal ? x + 1 : x;
    const int next_y = axis == vertical ? y + 1 : y;
    if (next_x / block_px != x / block_px || next_y / block_px != y / block_px) continue;
    if (!surface_.shows(pixel.material, next_x, next_y)) continue;
    block.step_mm[axis].add(surface_.at(next_x, next_y).position_mm[2] - pixel.position_mm[2]);
  }
}

/// The blocks within reach.
struct Blocks::Surroundings {
  Range depth_mm;
  std::array<Range, 2> step_mm;
  std::array<int, 2> size_px;  ///< columns and rows of pixels that lie in the frame
  bool is_partial;
};

Blocks::Surroundings Blocks::surroundings(Axis axis, int column, int row, const Extent& extent) const {
  std::array<int, 2> first{column, row};
  std::array<int, 2> last{column, row};
  const std::array<int, 2> frame_blocks{columns_, rows_};
  for (const Axis i : {horizontal, vertical}) {
    const int reach_blocks = i == axis ? extent.along_blocks : extent.side_blocks;
    first[i] = std::max(first[i] - reach_blocks, 0);
    last[i] = std::min(last[i] + reach_blocks, frame_blocks[i] - 1);
  }
  Surroundings all{};
  for (int j = first[vertical]; j <= last[vertical]; ++j) {
    for (int i = first[horizontal]; i <= last[horizontal]; ++i) {
      all.depth_mm.add(at(i, j).depth_mm);
      all.is_partial = all.is_partial || at(i, j).is_partial;
      for (const Axis along : {horizontal, vertical}) all.step_mm[along].add(at(i, j).step_mm[along]);
    }
  }
  const std::array<int, 2> frame_px{surface_.width(), surface_.height()};
  for (const Axis along : {horizontal, vertical}) {
    all.size_px[along] = std::min(block_px * (last[along] + 1), frame_px[along]) - block_px * first[along];
  }
  return all;
}

Blocks::Decision Blocks::is_at_most(Bounded a, Bounded b) {
  return {a.value <= b.value, a.high() > b.low() && a.low() <= b.high()};
}

Blocks::Decision Blocks::both(Decision a, Decision b) {
  const bool surely_not = (!a.yes && !a.unsure) || (!b.yes && !b.unsure);
  return {a.yes && b.yes, (a.unsure || b.unsure) && !surely_not};
}

/// How the position of the surface changes per pixel along a pass.
struct Blocks::Variation {
  Bounded squared_length;          ///< of T in the middle
  Bounded squared_length_varying;  ///< of dT
};

Blocks::Variation Blocks::variation(Axis axis, int column, int row, const ShearChoice& shear, const Range& depth_mm,
                                    const std::array<Range, 2>& step_mm) const {
  const View& view = surface_.view();
  const std::array<int, 2> corner_px{block_px * column, block_px * row};
  const Bounded side = shear.columns();
  const Range& along_mm = step_mm[axis];
  const Range& across_mm = step_mm[1 - axis];
  const Bounded step = along_mm.middle() + side * across_mm.middle();
  const Bounded varying_step = along_mm.half_range() + absolute(side) * across_mm.half_range();
  Tangent change;   // T
  Tangent varying;  // dT
  for (const Axis i : {horizontal, vertical}) {
    const Bounded ray = view.ray(i, corner_px[i] + block_px / 2.0);
    const Bounded pixels = i == axis ? exact(1) : side;
    change[i] = ray * step + pixels * view.size_mm(i, depth_mm.middle());
    varying[i] = absolute(ray) * varying_step + absolute(pixels) * view.growth_mm(i, depth_mm.half_range());
  }
  change[2] = step;
  varying[2] = varying_step;
  return {squared_length(change), squared_length(varying)};
}

/// In the middle of a block.
ShearChoice Blocks::shear(int column, int row) const {
  if (!surface_.is_sheared()) return {};
  const Block& block = at(column, row);
  const View& view = surface_.view();
  const std::array<int, 2> corner_px{block_px * column, block_px * row};
  std::array<Tangent, 2> tangents;
  for (const Axis axis : {horizontal, vertical}) {
    const Bounded step = block.step_mm[axis].middle();
    for (const Axis i : {horizontal, vertical}) {
      tangents[axis][i] = view.ray(i, corner_px[i] + block_px / 2.0) * step;
      if (i == axis) tangents[axis][i] = tangents[axis][i] + view.size_mm(i, block.depth_mm.middle());
    }
    tangents[axis][2] = step;
  }
  return whole_shear(shear_between(tangents[horizontal], tangents[vertical]));
}

void Blocks::add_kinds(Axis axis, int column, int row, const Extent& extent, std::vector<BlockClass>& kinds) const {
  const Block& block = at(column, row);
  const Surroundings near = surroundings(axis, column, row, extent);
  if (near.is_partial) {
    kinds.push_back({Shape::curved, block.px_per_mm[axis].bounded(), {}});
    return;
  }
  const Variation within_reach = variation(axis, column, row, extent.shear, near.depth_mm, near.step_mm);
  const Bounded length = square_root(within_reach.squared_length);
  Bounded largest_range = length;
  for (const Axis i : {horizontal, vertical}) {
    const Bounded steepest = absolute(near.step_mm[i].middle()) + near.step_mm[i].half_range();
    largest_range = largest_range + exact(near.size_px[i]) * steepest;
  }
  const Decision unbroken = is_at_most(exact(2) * near.depth_mm.half_range(), rounded(largest_range));
  const auto varies_at_most = [&](double share) {
    return both(unbroken, is_at_most(within_reach.squared_length_varying,
                                     exact(share) * exact(share) * within_reach.squared_length));
  };
  const Decision flat = varies_at_most(Taps::flatness);
  const Decision smooth = varies_at_most(Taps::smoothness);

  const auto add = [&](Shape shape) {
    switch (shape) {
      case Shape::flat:
        kinds.push_back({shape, exact(1) / length, extent.shear});
        break;
      case Shape::smooth:
        kinds.push_back(
            {shape,
             exact(1) /
                 square_root(variation(axis, column, row, extent.shear, block.depth_mm, block.step_mm).squared_length),
             extent.shear});
        break;
      case Shape::curved:
        kinds.push_back({shape, block.px_per_mm[axis].bounded(), {}});
    }
  };
  const Shape nominal = flat.yes ? Shape::flat : smooth.yes ? Shape::smooth : Shape::curved;
  const bool may_be_smooth = (smooth.yes || smooth.unsure) && (!flat.yes || flat.unsure);
  add(nominal);
  if (flat.unsure && nominal != Shape::flat) add(Shape::flat);
  if (may_be_smooth && nominal != Shape::smooth) add(Shape::smooth);
  if (smooth.unsure && nominal != Shape::curved) add(Shape::curved);
}

/// An eighth more than the farthest tap of the materials that scatter, for the largest px_per_mm.
Blocks::Reach Blocks::reach(Axis axis, const Block& block) const {
  const Bounded px_per_mm = block.px_per_mm[axis].bounded();
  Reach reach{};
  for (std::size_t m = 0; m < materials_.size(); ++m) {
    if (!block.perhaps_scatters[m]) continue;
    const Taps& taps = materials_[m].taps;
    const Bounded radius_px = px_per_mm * as_float(taps.radius_mm);
    if (block.scatters[m]) {
      reach.nominal_px = std::max(reach.nominal_px, farthest_px(level_step(radius_px.value, false, taps), taps));
    }
    int least_px = std::numeric_limits<int>::max();
    for (int step = level_step(radius_px.low(), false, taps); step <= level_step(radius_px.high(), false, taps);
         ++step) {
      const int its_px = farthest_px(step, taps);
      least_px = std::min(least_px, its_px);
      reach.most_px = std::max(reach.most_px, its_px);
    }
    if (block.surely_scatters[m]) reach.least_px = std::max(reach.least_px, least_px);
  }
  for (int* px : {&reach.nominal_px, &reach.least_px, &reach.most_px}) *px += *px / 8;
  return reach;
}

/// What lies within r pixels lies in the ceil(r / 16) blocks to either side.
std::vector<Blocks::Extent> Blocks::extents(Axis axis, int column, int row) const {
  const Reach reach_px = reach(axis, at(column, row));
  const ShearChoice shears = axis == vertical ? shear(column, row) : ShearChoice{};
  const int frame_px = std::max(surface_.width(), surface_.height());
  std::vector<Extent> all;
  const auto add = [&](const Extent& extent) {
    if (std::find(all.begin(), all.end(), extent) == all.end()) all.push_back(extent);
  };
  const auto add_sides = [&](int along_px) {
    along_px = std::min(along_px, frame_px);
    // A shear that moves no tap is none.
    for (const int side : sides_px(shears.magnitude(), along_px)) {
      add({blocks_over(along_px), blocks_over(side), side == 0 ? ShearChoice{} : shears});
    }
  };
  add_sides(reach_px.nominal_px);
  for (int along_px = reach_px.least_px; along_px <= reach_px.most_px; ++along_px) add_sides(along_px);
  return all;
}

std::vector<BlockClass> Blocks::kinds(Axis axis, int column, int row) const {
  const Block& block = at(column, row);
  if (!may_be_flat_) return {{Shape::curved, block.px_per_mm[axis].bounded(), {}}};
  std::vector<BlockClass> kinds;
  for (const Extent& extent : extents(axis, column, row)) add_kinds(axis, column, row, extent, kinds);
  return kinds;
}

}  // namespace dermis::oracle
