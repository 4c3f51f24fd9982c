/// Light that comes through thin parts from behind (Jimenez et al. 2010, Real-Time Realistic Skin Translucency; Golubev
/// 2018 for the thickness from an image), added to the light before a Plan scatters it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dermis/event.hpp"
#include "dermis/lights.hpp"
#include "dermis/plan.hpp"

namespace dermis {

struct TranslucencyOptions {
  Lighting lighting =
      Lighting::raw;  ///< what the light is: transmitted light goes without albedo if raw, with it if lit
  /// A point looks itself up in a map this far below the surface, against its normal, scene units >= 0, so that at its
  /// outline the object and not what is beside it is found. The paper has 0.005. Where light comes at an angle a to the
  /// normal it makes a slab thinner by shrink sin(a)^2 / cos(a).
  double shrink_units = 0.005;
  /// All thicknesses are multiplied with it, > 0: the paper's `scale`. The paper's code has exp(-s^2 / v) where a
  /// Gaussian of variance v transmits exp(-s^2 / 2v): sqrt(2) is as in the paper.
  double thickness_scale = 1;
  /// Half the side, texels 0..16, of the square of a map over which T is averaged (percentage-closer: T and not the
  /// thickness, which jumps to anything at an outline, whereas T lies in 0..1). 0: the nearest texel.
  double softness_texels = 0;

  bool operator==(const TranslucencyOptions&) const = default;
};

/// The images that the frames have, beside light, position and normal. No code is built for what they do not have.
struct TranslucencyDescription {
  bool albedo = false;
  bool material = false;
  bool mask = false;
  bool thickness = false;

  bool operator==(const TranslucencyDescription&) const = default;
};

/// One G-buffer. All images have the frame's size. A pixel stays as it is, to the bit, if it has no material, a normal
/// of no length, or anything that is not finite in an image that is read.
struct TranslucencyFrame {
  int width = 0;
  int height = 0;
  Image light = {};     ///< RGB, f16 or f32: as Frame::light
  Image albedo = {};    ///< RGB, f16 or f32: for lit light, for `result`, and where it sets a profile's width
  Image position = {};  ///< XYZ, f16 or f32: world space, scene units
  Image normal = {};    ///< XYZ, f16 or f32: world space, of any length; that of the vertices rather than of a bump map
  Image material = {};  ///< 1 channel, any format: as Frame::material
  Image mask = {};      ///< 1 channel, f16 or f32: as Frame::mask; where it is 0 nothing comes through
  Image thickness = {};    ///< 1 channel, f16 or f32: mm along the normal; negative counts as 0
  Image beauty = {};       ///< RGB, f16 or f32; needed for `result`
  double mm_per_unit = 1;  ///< millimetres per scene unit, 1e-18..1e18
  std::span<const Light> lights = {};

  OutputImage lit = {};     ///< RGB, f16 or f32: the light with what comes through; may be `light` itself
  OutputImage result = {};  ///< RGB, f16 or f32: `beauty` with albedo times that; may be `beauty` itself

  /// The description of the frame.
  TranslucencyDescription description() const {
    return {.albedo = static_cast<bool>(albedo),
            .material = static_cast<bool>(material),
            .mask = static_cast<bool>(mask),
            .thickness = static_cast<bool>(thickness)};
  }
};

/// Adds to the light of each pixel
///
///     sum over lights of T(s) colour attenuation cone max(0.3 + dot(-N, L), 0)
///
/// in which L is the direction to the light, and s the thickness: the larger one of that of the thickness image and
/// that of the light's map, which is the way of light from the surface the map shows to the point. T(s) is
/// Profile::transmittance, from a table that is within 1e-4 of it, where T(0) is exactly 1.
///
/// A point that a map shows, but not behind anything, has thickness 0 by the map, wherever it faces. A point off the
/// map, or behind the light, has none by the map: there the image decides, and without an image nothing comes through;
/// the same holds for a light without a map. Immutable; may be used from several threads at once.
class Translucency {
 public:
  /// Builds the kernels and the tables. Of the materials only id and profile count; without material ids there is
  /// exactly one. Throws Error(usage) for options or materials outside their ranges, Error(role_missing) if they need
  /// an image that the frames do not have, Error(device) if the device refuses the kernels.
  Translucency(const Device& device, const std::vector<Material>& materials, const TranslucencyDescription& frames,
               const TranslucencyOptions& options = {});
  ~Translucency();
  Translucency(Translucency&&) noexcept;
  Translucency& operator=(Translucency&&) noexcept;

  /// Works on one frame of host memory or of buffers and waits for it. Writes only the pixels of the outputs.
  /// Throws Error(usage) if the frame is not as described or malformed, Error(device) on a device error.
  void run(const TranslucencyFrame& frame) const;

  /// Puts the work of `run` on the caller's queue, as Plan::enqueue does. All images, those of maps too, are buffers.
  /// Never blocks.
  Event enqueue(const TranslucencyFrame& frame, cl_command_queue queue, std::span<const cl_event> wait_for = {}) const;

  struct State;  ///< not for callers

 private:
  std::unique_ptr<const State> state_;
};

}  // namespace dermis
