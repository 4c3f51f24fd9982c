/// What the samples of a disc read.
#pragma once

#include <optional>
#include <vector>

#include "oracle/frame/surface.hpp"
#include "oracle/integral/disc_texels.hpp"

namespace dermis::oracle {

/// Where a sample lies from the centre of its pixel, and the root of the area that it stands for, pixels.
struct SamplePlace {
  Bounded dx, dy;
  Bounded spacing;
};

/// A sample's means over the texels that it covers, by its shares of them.
struct Reading {
  BoundedRgb light;
  Bounded area_mm2;  ///< of surface per pixel; shares of texels of other materials count as 0
  Bounded rise_mm;   ///< how much deeper than the pixel the surface lies
};

/// Reads the samples of one pixel.
class DiscReader {
 public:
  /// Keeps references.
  DiscReader(const Surface& surface, const DiscTexels& texels, int x, int y)
      : surface_(surface), texels_(texels), x_(x), y_(y), pixel_(surface.at(x, y)) {}

  /// Returns every outcome that a device may come to; a sample without a share of any texel reads nothing.
  std::vector<std::optional<Reading>> read(const SamplePlace& place) const;

  /// Returns the squared distance, mm^2, to a point `rise` mm deeper than the pixel.
  Bounded squared_distance(const SamplePlace& place, Bounded rise) const;

 private:
  struct Square;
  struct Attempt;

  int level_of(double spacing) const;
  void read_from(int level, const SamplePlace& place, std::vector<std::optional<Reading>>& outcomes) const;
  Attempt read_square(const Square& square, const SamplePlace& place) const;

  const Surface& surface_;
  const DiscTexels& texels_;
  int x_, y_;
  const SurfacePixel& pixel_;
};

}  // namespace dermis::oracle
