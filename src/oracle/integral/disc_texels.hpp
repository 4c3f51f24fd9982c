/// What samples of discs read: pixels, and blocks of 2 x 2, 4 x 4, ... of them.
#pragma once

#include <array>
#include <vector>

#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

struct Texel {
  int material = -1;             ///< that gives light from all of it; -1: none does
  bool material_unsure = false;  ///< a device may find that the block bends too much, or too little
  std::array<Bounded, 3> light{};
  Bounded area_mm2;  ///< of surface per pixel
  Bounded z_mm;      ///< in the middle
  std::array<Bounded, 2> slope{};
};

class DiscTexels {
 public:
  /// `levels`: how many sizes of blocks, pixels included.
  DiscTexels(const Surface& surface, const BoundedPicture& light, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }

  /// nullptr outside the frame, where blocks that do not lie in it as a whole are too.
  const Texel* at(int level, int x, int y) const;

 private:
  struct Level {
    int width, height;
    std::vector<Texel> texels;
  };
  static Level halved(const Level& finer, int side_px);

  std::vector<Level> levels_;
};

}  // namespace dermis::oracle
