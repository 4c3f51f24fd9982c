/// Blocks of 16 x 16 pixels: their shape, and what px_per_mm their levels are chosen by. See Taps.
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <limits>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/frame/view.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

inline constexpr int block_px = 16;

enum class Shape { flat, smooth, curved };

/// What a pass makes of a block.
struct BlockClass {
  Shape shape;
  Bounded px_per_mm;  ///< px per mm: the largest of the pixels times k, or unless curved that of the tilted surface
  ShearChoice shear;  ///< of the vertical pass; 0 if curved
};

class Blocks {
 public:
  /// Keeps references. `may_be_flat`: no pixel has a width of its own and no tap is rotated.
  Blocks(const Surface& surface, std::span<const Material> materials, bool may_be_flat);

  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// What a pass along that axis makes of a block: first the oracle's decision, then any other that a float32 device
  /// may come to. The px_per_mm is 0 if no pixel scatters.
  std::vector<BlockClass> kinds(Axis axis, int column, int row) const;

  /// Calls visit(x, y) for the pixels of a block that lie in the frame.
  template <typename Visit>
  void for_each_pixel(int column, int row, const Visit& visit) const {
    for (int y = block_px * row; y < std::min(block_px * (row + 1), surface_.height()); ++y) {
      for (int x = block_px * column; x < std::min(block_px * (column + 1), surface_.width()); ++x) visit(x, y);
    }
  }

 private:
  /// The smallest and the largest of some values.
  class Range {
   public:
    void add(Bounded value);
    void add(const Range& other);
    Bounded middle() const;      ///< 0 if there are no values
    Bounded half_range() const;  ///< 0 if there are no values

   private:
    double low_ = std::numeric_limits<double>::infinity();
    double high_ = -std::numeric_limits<double>::infinity();
    double error_ = 0;
  };

  /// The largest of some values, of which a device may leave out some.
  class Largest {
   public:
    void add(Bounded value, bool counts, bool unsure);
    Bounded bounded() const { return {nominal_, std::max(high_ - nominal_, nominal_ - low_)}; }

   private:
    double low_ = 0;
    double nominal_ = 0;
    double high_ = 0;
  };

  static constexpr std::size_t most_materials = 127;
  using MaterialSet = std::bitset<most_materials>;

  struct Block {
    Range depth_mm;
    std::array<Range, 2> step_mm;  ///< change of depth to the next pixel of the same material, along x and along y
    std::array<Largest, 2> px_per_mm;
    MaterialSet scatters;          ///< some pixel has a wide kernel of that material
    MaterialSet surely_scatters;   ///< on any device
    MaterialSet perhaps_scatters;  ///< on some
    bool is_partial = false;       ///< a material covers only a part of some pixel
  };

  /// How far around a block its pixels' surroundings are looked at.
  struct Reach {
    int nominal_px;
    int least_px;  ///< of a device
    int most_px;
  };

  /// A decision: what it is, and whether a device may decide otherwise.
  struct Decision {
    bool yes;
    bool unsure;
  };

  /// What is looked at around a block, and along which shear.
  struct Extent {
    int along_blocks;  ///< to either side along the pass
    int side_blocks;   ///< across it
    ShearChoice shear;

    bool operator==(const Extent&) const = default;
  };

  struct Surroundings;

  void add_pixel(Block& block, int x, int y) const;
  Reach reach(Axis axis, const Block& block) const;
  const Block& at(int column, int row) const { return blocks_[static_cast<std::size_t>(row) * columns_ + column]; }
  Surroundings surroundings(Axis axis, int column, int row, const Extent& extent) const;
  struct Variation;
  Variation variation(Axis axis, int column, int row, const ShearChoice& shear, const Range& depth_mm,
                      const std::array<Range, 2>& step_mm) const;
  ShearChoice shear(int column, int row) const;
  std::vector<Extent> extents(Axis axis, int column, int row) const;
  void add_kinds(Axis axis, int column, int row, const Extent& extent, std::vector<BlockClass>& kinds) const;
  static Decision is_at_most(Bounded a, Bounded b);
  static Decision both(Decision a, Decision b);

  const Surface& surface_;
  std::span<const Material> materials_;
  bool may_be_flat_;
  int columns_;
  int rows_;
  std::vector<Block> blocks_;
};

}  // namespace dermis::oracle
