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

void Blocks::Relief::add(const Relief& other) {
  depth_mm.add(other.depth_mm);
  for (const Axis axis : {horizontal, vertical}) step_mm[axis].add(other.step_mm[axis]);
  is_partial = is_partial || other.is_partial;
}

Blocks::Blocks(const Surface& surface, std::span<const Material> materials, bool may_be_flat)
    : surface_(surface),
      materials_(materials),
      may_be_flat_(may_be_flat),
      size_px_{surface.width(), surface.height()},
      size_blocks_{blocks_over(surface.width()), blocks_over(surface.height())} {
  for (int row = 0; row < rows(); ++row) {
    for (int column = 0; column < columns(); ++column) {
      Block block;
      for_each_pixel(column, row, [&](int x, int y) { add_pixel(block, x, y); });
      blocks_.push_back(block);
    }
  }
}

void Blocks::add_pixel(Block& block, int x, int y) const {
  const SurfacePixel& pixel = surface_.at(x, y);
  if (pixel.material < 0) return;
  if (pixel.wide) block.scatters.set(pixel.material);
  if (pixel.wide && !pixel.wide_unsure) block.surely_scatters.set(pixel.material);
  if (pixel.wide || pixel.wide_unsure) block.perhaps_scatters.set(pixel.material);
  Relief& relief = block.relief;
  relief.is_partial = relief.is_partial || pixel.covered < 1;
  relief.depth_mm.add(pixel.position_mm[2]);
  for (const Axis axis : {horizontal, vertical}) {
    block.px_per_mm[axis].add(pixel.effective_px_per_mm[axis], pixel.wide, pixel.wide_unsure);
    const int next_x = axis == horizontal ? x + 1 : x;
    const int next_y = axis == vertical ? y + 1 : y;
    if (next_x / block_px != x / block_px || next_y / block_px != y / block_px) continue;
    if (!surface_.shows(pixel.material, next_x, next_y)) continue;
    relief.step_mm[axis].add(surface_.at(next_x, next_y).position_mm[2] - pixel.position_mm[2]);
  }
}

/// The surface that decides on the class of a block.
struct Blocks::Surroundings {
  Relief relief;
  std::array<int, 2> size_px;  ///< columns and rows of pixels that lie in the frame
};

Blocks::Surroundings Blocks::surroundings(Axis axis, const Place& place, const Extent& extent) const {
  Place first = place;
  Place last = place;
  Surroundings all{};
  for (const Axis i : {horizontal, vertical}) {
    const int reach_blocks = i == axis ? extent.along_blocks : extent.side_blocks;
    first[i] = std::max(first[i] - reach_blocks, 0);
    last[i] = std::min(last[i] + reach_blocks, size_blocks_[i] - 1);
    all.size_px[i] = std::min(block_px * (last[i] + 1), size_px_[i]) - block_px * first[i];
  }
  for (int row = first[vertical]; row <= last[vertical]; ++row) {
    for (int column = first[horizontal]; column <= last[horizontal]; ++column) all.relief.add(at({column, row}).relief);
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
  Bounded squared_length;          ///< of T, the change in the middle of the ranges, mm^2
  Bounded squared_length_varying;  ///< of dT, by which the change may differ from T, mm^2
};

/// The rays are those through the middle of the block at `place`, `relief` is that of its surroundings.
Blocks::Variation Blocks::variation(Axis axis, const Place& place, const BoundedShear& shear,
                                    const Relief& relief) const {
  const View& view = surface_.view();
  const Bounded side = shear.columns();
  const Range& along_mm = relief.step_mm[axis];
  const Range& across_mm = relief.step_mm[1 - axis];
  const Bounded step = along_mm.middle() + side * across_mm.middle();
  const Bounded varying_step = along_mm.half_range() + absolute(side) * across_mm.half_range();
  Tangent change;   // T
  Tangent varying;  // dT
  for (const Axis i : {horizontal, vertical}) {
    const Bounded ray = view.ray(i, block_px * place[i] + block_px / 2.0);
    const Bounded pixels = i == axis ? exact(1) : side;
    change[i] = ray * step + pixels * view.size_mm(i, relief.depth_mm.middle());
    varying[i] = absolute(ray) * varying_step + absolute(pixels) * view.growth_mm(i, relief.depth_mm.half_range());
  }
  change[2] = step;
  varying[2] = varying_step;
  return {squared_length(change), squared_length(varying)};
}

/// Returns the shear in the middle of a block.
BoundedShear Blocks::shear(const Place& place) const {
  if (!surface_.is_sheared()) return {};
  const Relief& relief = at(place).relief;
  const View& view = surface_.view();
  std::array<Tangent, 2> tangents;
  for (const Axis axis : {horizontal, vertical}) {
    const Bounded step = relief.step_mm[axis].middle();
    for (const Axis i : {horizontal, vertical}) {
      tangents[axis][i] = view.ray(i, block_px * place[i] + block_px / 2.0) * step;
      if (i == axis) tangents[axis][i] = tangents[axis][i] + view.size_mm(i, relief.depth_mm.middle());
    }
    tangents[axis][2] = step;
  }
  return whole_shear(shear_between(tangents[horizontal], tangents[vertical]));
}

void Blocks::add_passes(Axis axis, const Place& place, const Extent& extent, std::vector<BlockPass>& passes) const {
  const Block& block = at(place);
  const BlockPass curved{BlockClass::curved, block.px_per_mm[axis].bounded(), {}};
  const Surroundings near = surroundings(axis, place, extent);
  if (near.relief.is_partial) {
    passes.push_back(curved);
    return;
  }
  const Variation change = variation(axis, place, extent.shear, near.relief);
  const Bounded length = square_root(change.squared_length);
  Bounded largest_range = length;
  for (const Axis i : {horizontal, vertical}) {
    const Range& step_mm = near.relief.step_mm[i];
    const Bounded steepest = absolute(step_mm.middle()) + step_mm.half_range();
    largest_range = largest_range + exact(near.size_px[i]) * steepest;
  }
  const Decision unbroken = is_at_most(exact(2) * near.relief.depth_mm.half_range(), rounded(largest_range));
  const Bounded share = exact(Taps::flatness) * exact(Taps::flatness);
  const Decision flat = both(unbroken, is_at_most(change.squared_length_varying, share * change.squared_length));
  const BlockPass plane{BlockClass::flat, exact(1) / length, extent.shear};
  passes.push_back(flat.yes ? plane : curved);
  if (flat.unsure) passes.push_back(flat.yes ? curved : plane);
}

/// The reach is 9/8 of the distance of the farthest tap of any material that scatters, at the block's largest
/// px_per_mm.
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
      const int step_px = farthest_px(step, taps);
      least_px = std::min(least_px, step_px);
      reach.most_px = std::max(reach.most_px, step_px);
    }
    if (block.surely_scatters[m]) reach.least_px = std::max(reach.least_px, least_px);
  }
  for (int* px : {&reach.nominal_px, &reach.least_px, &reach.most_px}) *px += *px / 8;
  return reach;
}

/// Pixels within a reach of r lie in the ceil(r / 16) blocks to either side.
std::vector<Blocks::Extent> Blocks::extents(Axis axis, const Place& place) const {
  const Reach reach_px = reach(axis, at(place));
  const BoundedShear of_block = axis == vertical ? shear(place) : BoundedShear{};
  const int longest_px = std::max(size_px_[horizontal], size_px_[vertical]);
  std::vector<Extent> all;
  const auto add = [&](const Extent& extent) {
    if (std::find(all.begin(), all.end(), extent) == all.end()) all.push_back(extent);
  };
  const auto add_sides = [&](int along_px) {
    along_px = std::min(along_px, longest_px);
    // A shear that moves no tap counts as none.
    for (const int side : sides_px(of_block.magnitude(), along_px, most_flat_side_px)) {
      add({blocks_over(along_px), blocks_over(side), side == 0 ? BoundedShear{} : of_block});
    }
  };
  add_sides(reach_px.nominal_px);
  for (int along_px = reach_px.least_px; along_px <= reach_px.most_px; ++along_px) add_sides(along_px);
  return all;
}

std::vector<BlockPass> Blocks::classify(Axis axis, int column, int row) const {
  const Place place{column, row};
  if (!may_be_flat_) return {{BlockClass::curved, at(place).px_per_mm[axis].bounded(), {}}};
  std::vector<BlockPass> passes;
  for (const Extent& extent : extents(axis, place)) add_passes(axis, place, extent, passes);
  return passes;
}

}  // namespace dermis::oracle
