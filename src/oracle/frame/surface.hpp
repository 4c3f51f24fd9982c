/// What the pixels of a frame show: which material, where, and how wide light spreads there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/oracle/reference.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/shear.hpp"
#include "oracle/frame/view.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// One pixel. Where there is no material, nothing else is known.
struct SurfacePixel {
  int material = -1;         ///< index into the materials, by id, depth, mask and matte; -1: none
  bool bad = false;          ///< light or albedo not finite: part of the surface, but neither gives nor takes light
  bool wide = false;         ///< has a kernel at least half a pixel wide
  bool wide_unsure = false;  ///< so close to half a pixel that a float32 device may decide otherwise
  double covered = 1;        ///< m, the share of the pixel that is of the material, above 0
  std::array<Bounded, 3> position_mm{};
  std::array<Bounded, 2> px_per_mm{};     ///< px per mm along x and y
  std::array<Bounded, 3> width_factor{};  ///< k: the profile is R(r / k) / k^2
  std::array<Bounded, 2> segment_mm{};    ///< length of surface that the pixel spans along either pass, times m^2
  std::array<Bounded, 2> effective_px_per_mm{};  ///< px_per_mm times the widest channel's k, px per mm

  bool gives_light() const { return material >= 0 && !bad; }
  bool takes_light() const { return wide && !bad; }
  bool takes_light_unsure() const { return wide_unsure && !bad; }
};

/// How a surface differs about a pixel from a plane parallel to the screen of some px_per_mm: q and k of Taps, before
/// they are held within bounds.
struct Bend {
  Bounded stretch;
  Bounded skew;
};

/// Of the patch of a pixel, whose sides they are, mm^2.
Bounded patch_area(const Tangent& x, const Tangent& y);

class Surface {
 public:
  /// `sheared`: the vertical pass runs along the shear of each pixel, not along y.
  /// Throws Error(usage) if there is no material, or several and no material ids, Error(role_missing) if a width
  /// follows an albedo that is not there.
  Surface(const Frame& frame, const FrameImages& images, std::span<const Material> materials, bool sheared);

  int width() const { return width_; }
  int height() const { return height_; }
  const View& view() const { return view_; }
  bool is_sheared() const { return sheared_; }

  const SurfacePixel& at(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }

  /// True if the pixel is in the image and of that material, bad or not.
  bool shows(int material, int x, int y) const {
    return x >= 0 && y >= 0 && x < width_ && y < height_ && at(x, y).material == material;
  }

  /// Change of depth per pixel along an axis, mm: the smaller one of the differences to both neighbours of the same
  /// material, 0 if they differ in sign.
  Bounded depth_slope(int x, int y, Axis axis) const;

  /// Change of position with one pixel along an axis where depth changes so much, mm.
  Tangent tangent(int x, int y, Axis axis, Bounded slope) const;

  /// The shear of a pixel.
  ShearChoice shear(int x, int y) const;

  /// `shear`: of the vertical pass.
  Bend bend(int x, int y, Axis axis, const ShearChoice& shear, float px_per_mm) const;

  /// 1 channel: 1 where a pixel takes light.
  Picture touched() const;

 private:
  struct DepthSteps;
  DepthSteps depth_steps(int x, int y, Axis axis) const;
  Bounded cross_step(int x, int y, const DepthSteps& along_x, const DepthSteps& along_y) const;
  Tangent tangent(int x, int y, Axis axis) const;
  Bounded segment(int x, int y, Axis axis) const;

  bool sheared_;
  int width_;
  int height_;
  View view_;
  std::vector<SurfacePixel> pixels_;
};

}  // namespace dermis::oracle
