/// Blocks of 16 x 16 pixels: their class, and by how many pixels per mm their levels are chosen. See Taps.
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

enum class BlockClass { flat, curved };

/// How a pass scatters a block.
struct BlockPass {
  BlockClass block_class;
  Bounded px_per_mm;  ///< if curved, the largest of the pixels' times k, 0 if none scatters; else of the tilted surface
  BoundedShear shear;  ///< of the vertical pass; 0 if curved
};

class Blocks {
 public:
  /// Keeps references. `may_be_flat` says that no pixel has a width of its own and no tap is rotated.
  Blocks(const Surface& surface, std::span<const Material> materials, bool may_be_flat);

  int columns() const { return size_blocks_[horizontal]; }
  int rows() const { return size_blocks_[vertical]; }

  /// Returns how a pass along that axis scatters a block: the oracle's decision first, then any other that a float32
  /// device may come to.
  std::vector<BlockPass> classify(Axis axis, int column, int row) const;

  /// Calls visit(x, y) for the pixels of a block that lie in the frame.
  template <typename Visit>
  void for_each_pixel(int column, int row, const Visit& visit) const {
    for (int y = block_px * row; y < std::min(block_px * (row + 1), surface_.height()); ++y) {
      for (int x = block_px * column; x < std::min(block_px * (column + 1), surface_.width()); ++x) visit(x, y);
    }
  }

 private:
  /// The smallest and the largest of some values. Its results are 0 if there are no values.
  class Range {
   public:
    void add(Bounded value);
    void add(const Range& other);
    Bounded middle() const;
    Bounded half_range() const;

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

  /// The depths that some pixels show.
  struct Relief {
    Range depth_mm;
    std::array<Range, 2> step_mm;  ///< change of depth to the next pixel of the same material, along x and along y
    bool is_partial = false;       ///< a material covers only a part of some pixel

    void add(const Relief& other);
  };

  struct Block {
    Relief relief;
    std::array<Largest, 2> px_per_mm;
    MaterialSet scatters;          ///< some pixel has a wide kernel of that material
    MaterialSet surely_scatters;   ///< on any device
    MaterialSet perhaps_scatters;  ///< on some
  };

  /// Column and row of a block.
  using Place = std::array<int, 2>;

  /// The distance within which the surface around a block decides on its class.
  struct Reach {
    int nominal_px;
    int least_px;  ///< of a device
    int most_px;
  };

  /// A decision, and whether a device may decide otherwise.
  struct Decision {
    bool yes;
    bool unsure;
  };

  /// The blocks around a block that decide on its class, and the shear of the pass.
  struct Extent {
    int along_blocks;  ///< to either side along the pass
    int side_blocks;   ///< across it
    BoundedShear shear;

    bool operator==(const Extent&) const = default;
  };

  struct Surroundings;
  struct Variation;

  void add_pixel(Block& block, int x, int y) const;
  const Block& at(const Place& place) const {
    return blocks_[static_cast<std::size_t>(place[vertical]) * columns() + place[horizontal]];
  }
  Reach reach(Axis axis, const Block& block) const;
  std::vector<Extent> extents(Axis axis, const Place& place) const;
  Surroundings surroundings(Axis axis, const Place& place, const Extent& extent) const;
  BoundedShear shear(const Place& place) const;
  Variation variation(Axis axis, const Place& place, const BoundedShear& shear, const Relief& relief) const;
  void add_passes(Axis axis, const Place& place, const Extent& extent, std::vector<BlockPass>& passes) const;
  static Decision is_at_most(Bounded a, Bounded b);
  static Decision both(Decision a, Decision b);

  const Surface& surface_;
  std::span<const Material> materials_;
  bool may_be_flat_;
  std::array<int, 2> size_px_;      ///< of the frame
  std::array<int, 2> size_blocks_;  ///< columns and rows
  std::vector<Block> blocks_;
};

}  // namespace dermis::oracle
