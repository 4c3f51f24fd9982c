/// Diffuse light and highlights of a G-buffer that has neither, with care for energy (d'Eon 2007, "careful conservation
/// of energy"; Kelemen and Szirmay-Kalos 2001): the light that the highlight leaves is the light that scatters.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/event.hpp"
#include "dermis/frame.hpp"
#include "dermis/lights.hpp"

namespace dermis {

/// One lobe of a highlight.
struct SpecularLobe {
  double roughness;  ///< m of Beckmann's distribution, 0.02..1
  double weight;     ///< >= 0

  bool operator==(const SpecularLobe&) const = default;
};

/// A highlight, and how shadows are looked up.
struct ShadingOptions {
  /// At most four. Their sum must leave something of the light under every angle.
  std::vector<SpecularLobe> lobes = {{0.05, 0.1}, {0.1, 0.2}, {0.2, 0.3}, {0.3, 0.5}};  // d'Eon 2007
  /// Share of light that is reflected head on, F0, 0..1; Schlick 1994 gives the rest. The default is ((n - 1) / (n +
  /// 1))^2 for the talk's n = 1.4.
  double reflectance = 0.0277777777777777778;
  /// A point looks itself up in a map above the surface, along its normal, so that it does not lie in its own shadow:
  /// (this + softness_texels) sqrt(2) times the size of a texel at the point. 0..1e6; from 0.5 on a plane is free of
  /// its own shadow under any angle, the rest is for rounding.
  double normal_offset_texels = 0.6;
  /// Half the side, texels 0..16, of the square of a map over which shadow is averaged. 0: the nearest texel.
  double softness_texels = 0;

  bool operator==(const ShadingOptions&) const = default;
};

/// The place that a picture is seen from.
struct Viewer {
  Camera::Projection projection = Camera::Projection::perspective;
  /// World space: the eye if perspective, scene units; the direction in which the camera looks if orthographic.
  std::array<double, 3> place = {0, 0, 0};
};

/// One G-buffer. All images have the frame's size. Outputs may lie over each other's inputs only in the same place and
/// layout. A pixel of the outputs stays as it is, to the bit, if the normal has no length, or position, normal or
/// albedo is not finite.
struct ShadingFrame {
  int width = 0;
  int height = 0;
  Image position = {};  ///< XYZ, f16 or f32: world space, scene units
  Image normal = {};    ///< XYZ, f16 or f32: world space, of any length
  Image albedo = {};    ///< RGB, f16 or f32
  Viewer viewer = {};
  std::span<const Light> lights = {};

  OutputImage light = {};  ///< RGB, f16 or f32: diffuse light without albedo
  OutputImage seen = {};   ///< RGB, f16 or f32: the albedo, less what the highlight keeps of light that leaves; may be
                           ///< `albedo` itself
  OutputImage specular = {};  ///< RGB, f16 or f32
  OutputImage beauty = {};    ///< RGB, f16 or f32: light x seen + specular
};

/// Lights a frame. With N, L and V the directions of the normal, to a light and to the viewer, H = L + V, a the angle
/// between N and H, and "light" a light's colour x attenuation x cone x what of it no shadow takes,
///
///     specular = sum light max(N.L, 0) f        f = F P(a) / (H.H)
///     P(a) = sum over lobes of weight exp(-(tan a / m)^2) / (m^2 cos^4 a)       Beckmann
///     F = F0 + (1 - F0) (1 - V.H / |H|)^5                                       Schlick
///     light = sum light max(N.L, 0) (1 - rho(N.L))
///     seen = albedo (1 - rho(N.V)) / (1 - rho_mean)
///
/// where rho(cos) is the share of light of that direction that the highlight reflects, and rho_mean its mean for light
/// from all sides: 2 times the integral of rho(c) c. A surface of albedo 1 under the same light from all sides then
/// shows that light again. P and rho are tables, within 1e-5 of their largest value. A point off a light's map, or
/// behind the light, is not in shadow. A point whose normal looks away from the viewer shows no highlight, and N.V is
/// 0. Immutable; may be used from several threads at once.
class Shading {
 public:
  /// Builds the kernels and the tables. Throws Error(usage) for options outside their ranges, Error(device) if the
  /// device refuses the kernels.
  explicit Shading(const Device& device, const ShadingOptions& options = {});
  ~Shading();
  Shading(Shading&&) noexcept;
  Shading& operator=(Shading&&) noexcept;

  /// Works on one frame of host memory or of buffers and waits for it. Writes only the pixels of the outputs, of which
  /// there is at least one. Throws Error(usage) if the frame is malformed, Error(role_missing) if an image is missing,
  /// Error(device) on a device error.
  void run(const ShadingFrame& frame) const;

  /// Puts the work of `run` on the caller's queue, as Plan::enqueue does. All images, those of maps too, are buffers.
  /// Never blocks.
  Event enqueue(const ShadingFrame& frame, cl_command_queue queue, std::span<const cl_event> wait_for = {}) const;

  struct State;  ///< not for callers

 private:
  std::unique_ptr<const State> state_;
};

}  // namespace dermis
