/// The texels that disc samples read: pixels, and blocks of 2 x 2, 4 x 4, ... pixels.
#pragma once

#include <array>
#include <vector>

#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

struct Texel {
  int material = -1;             ///< the material that gives light from all of the texel; -1: none does
  bool material_unsure = false;  ///< a device may decide otherwise on whether the block lies nearly in a plane
  BoundedRgb light{};
  Bounded area_mm2;  ///< of surface per pixel
  Bounded z_mm;      ///< in the middle
  std::array<Bounded, 2> slope{};
};

class DiscTexels {
 public:
  /// `levels` limits how many sizes of texels there are, pixels included.
  DiscTexels(const Surface& surface, const BoundedPicture& light, int levels);

  int levels() const { return static_cast<int>(levels_.size()); }

  /// Returns nullptr outside the frame, and for blocks that do not lie in the frame as a whole.
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
