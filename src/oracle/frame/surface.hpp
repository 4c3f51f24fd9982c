/// The surface that the pixels of a frame show: its material, where it lies, and how wide light spreads there.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/oracle/reference.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/shear.hpp"
#include "oracle/frame/view.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// The surface in one pixel. Without a material the other members have no meaning.
struct SurfacePixel {
  int material = -1;         ///< index into the materials, which id, depth, mask and matte decide; -1: none
  bool bad = false;          ///< light or albedo are not finite: the pixel is surface, but gives and takes no light
  bool wide = false;         ///< the kernel's radius is at least half a pixel
  bool wide_unsure = false;  ///< it is so close to half a pixel that a float32 device may decide otherwise
  double covered = 1;        ///< m, the share of the pixel that the material covers, above 0
  std::array<Bounded, 3> position_mm{};
  Bounded slant_mm{};                            ///< see View::slant_mm
  std::array<Bounded, 2> px_per_mm{};            ///< along x and y
  std::array<Bounded, 3> width_factor{};         ///< k: the profile is R(r / k) / k^2
  std::array<Bounded, 2> segment_mm{};           ///< length of surface in the pixel along each pass, times m^2
  std::array<Bounded, 2> effective_px_per_mm{};  ///< px_per_mm times the widest channel's k

  bool gives_light() const { return material >= 0 && !bad; }
  bool takes_light() const { return wide && !bad; }
  bool takes_light_unsure() const { return wide_unsure && !bad; }
};

/// Returns the area of the patch of surface in a pixel, mm^2, given its sides.
Bounded patch_area(const Tangent& x, const Tangent& y);

class Surface {
 public:
  /// `light` is that of the images. If `sheared`, the vertical pass runs along the shear of each run of pixels, not
  /// along y. Throws Error(usage) if there is no material, or several and no material ids, Error(role_missing) if a
  /// width follows an albedo that is not there.
  Surface(const Frame& frame, const FrameImages& images, std::span<const Material> materials, const Light& light,
          bool sheared);

  int width() const { return width_; }
  int height() const { return height_; }
  const View& view() const { return view_; }
  bool is_sheared() const { return sheared_; }

  const SurfacePixel& at(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }

  /// Returns whether the pixel lies in the frame and has that material, be it bad or not.
  bool shows(int material, int x, int y) const {
    return x >= 0 && y >= 0 && x < width_ && y < height_ && at(x, y).material == material;
  }

  /// Returns the change of depth per pixel along an axis, mm: the smaller of the differences to both neighbours of the
  /// material, or 0 if they differ in sign.
  Bounded depth_slope(int x, int y, Axis axis) const;

  /// Returns the change of position per pixel along an axis, mm, where the depth changes by `slope`, mm per pixel.
  Tangent tangent(int x, int y, Axis axis, Bounded slope) const;

  /// Returns the shear of the run of pixels in which a pixel lies; 0 if the surface is not sheared. See METHODS.md,
  /// "The separable passes".
  BoundedShear shear(int x, int y) const;

  /// Returns the squared distance of two pixels, mm^2.
  Bounded distance2_mm2(int x, int y, int other_x, int other_y) const;

  /// Returns 1 channel, which is 1 where a pixel takes light and 0 elsewhere.
  Picture touched() const;

 private:
  Bounded ray(int x, int y, Axis axis) const;
  Tangent tangent(int x, int y, Axis axis) const { return tangent(x, y, axis, depth_slope(x, y, axis)); }
  Tangent normal(int x, int y) const;
  int runs_per_row() const { return (width_ + shear_run_px - 1) / shear_run_px; }
  BoundedShear run_shear(int run, int y) const;
  Bounded segment(int x, int y, Axis axis) const;

  bool sheared_;
  int width_;
  int height_;
  View view_;
  std::vector<SurfacePixel> pixels_;
  std::vector<BoundedShear> shears_;  ///< of the runs, row by row
};

}  // namespace dermis::oracle
