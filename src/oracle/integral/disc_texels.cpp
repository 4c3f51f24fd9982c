#include "oracle/integral/disc_texels.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "oracle/math/weighted_sum.hpp"

namespace dermis::oracle {

namespace {

constexpr double most_bend = 0.25;  ///< distance of texels from a common plane over the block's side

Texel pixel_texel(const Surface& surface, const BoundedPicture& light, int x, int y) {
  const SurfacePixel& pixel = surface.at(x, y);
  Texel texel;
  if (!pixel.gives_light()) return texel;
  texel.material = pixel.material;
  for (int c = 0; c < 3; ++c) texel.light[c] = light.at(x, y, c);
  texel.z_mm = pixel.position_mm[2];
  for (const Axis axis : {horizontal, vertical}) texel.slope[axis] = surface.depth_slope(x, y, axis);
  const Bounded counted = exact(pixel.covered) * exact(pixel.covered);
  texel.area_mm2 = counted * patch_area(surface.tangent(x, y, horizontal, texel.slope[horizontal]),
                                        surface.tangent(x, y, vertical, texel.slope[vertical]));
  return texel;
}

Bounded mean(Bounded a, Bounded b, Bounded c, Bounded d) { return rounded((a + b) + (c + d), 2) * exact(0.25); }

/// Joins four texels, given row by row, to one of twice the side, `side_px`.
Texel block_of(const std::array<const Texel*, 4>& four, int side_px) {
  Texel block;
  block.material = four[0]->material;
  for (const Texel* texel : four) {
    if (texel->material != block.material) block.material = -1;
    block.material_unsure = block.material_unsure || texel->material_unsure;
  }
  if (block.material < 0) return {};
  const auto mean_of = [&](auto part) { return mean(part(*four[0]), part(*four[1]), part(*four[2]), part(*four[3])); };
  block.area_mm2 = mean_of([](const Texel& t) { return t.area_mm2; });
  block.z_mm = mean_of([](const Texel& t) { return t.z_mm; });
  for (const Axis axis : {horizontal, vertical})
    block.slope[axis] = mean_of([&](const Texel& t) { return t.slope[axis]; });
  for (int c = 0; c < 3; ++c) {
    WeightedSum sum;
    for (const Texel* texel : four) sum.add(texel->area_mm2, texel->light[c]);
    block.light[c] = rounded(sum.mean(exact(0)), 4);
  }
  const Bounded quarter = exact(0.25 * side_px);
  const Bounded most = exact(most_bend * side_px) * square_root(block.area_mm2);
  for (int i = 0; i < 4; ++i) {
    const Bounded along_x = quarter * block.slope[horizontal];
    const Bounded along_y = quarter * block.slope[vertical];
    Bounded off = four[i]->z_mm - block.z_mm;
    off = (i & 1) != 0 ? off - along_x : off + along_x;
    off = absolute((i & 2) != 0 ? off - along_y : off + along_y);
    // A device may add the slopes to the depth of the block first.
    off.error += 4 * unit_roundoff * (block.z_mm.magnitude() + along_x.magnitude() + along_y.magnitude());
    if (off.low() > most.high()) return {};
    if (off.high() > most.low()) block.material_unsure = true;
  }
  return block;
}

}  // namespace

DiscTexels::DiscTexels(const Surface& surface, const BoundedPicture& light, int levels) {
  Level pixels{surface.width(), surface.height(), {}};
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) pixels.texels.push_back(pixel_texel(surface, light, x, y));
  }
  levels_.push_back(std::move(pixels));
  while (static_cast<int>(levels_.size()) < levels && levels_.back().width > 1 && levels_.back().height > 1) {
    levels_.push_back(halved(levels_.back(), 1 << levels_.size()));
  }
}

DiscTexels::Level DiscTexels::halved(const Level& finer, int side_px) {
  Level level{finer.width / 2, finer.height / 2, {}};
  const auto texel = [&](int x, int y) { return &finer.texels[static_cast<std::size_t>(y) * finer.width + x]; };
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      level.texels.push_back(
          block_of({texel(2 * x, 2 * y), texel(2 * x + 1, 2 * y), texel(2 * x, 2 * y + 1), texel(2 * x + 1, 2 * y + 1)},
                   side_px));
    }
  }
  return level;
}

const Texel* DiscTexels::at(int level, int x, int y) const {
  const auto& [width, height, texels] = levels_[level];
  if (x < 0 || y < 0 || x >= width || y >= height) return nullptr;
  return &texels[static_cast<std::size_t>(y) * width + x];
}

}  // namespace dermis::oracle
