/// A G-buffer: the places of its pixels in memory, and the camera that saw them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "dermis/words.hpp"

struct _cl_mem;
using cl_mem = struct _cl_mem*;

namespace dermis {

/// The kind of light in Frame::light.
enum class Lighting {
  raw,  ///< irradiance: the albedo is not in it
  lit,  ///< irradiance times albedo; where an albedo is below 1e-4 the irradiance counts as 0
};

template <>
inline constexpr std::array<Named<Lighting>, 2> word_table<Lighting> = {
    {{Lighting::raw, "raw"}, {Lighting::lit, "lit"}}};

/// Formats of a value.
enum class Format : std::uint8_t { f16, f32, u8, u16, u32 };

constexpr std::size_t bytes_of(Format format) {
  switch (format) {
    case Format::u8:
      return 1;
    case Format::f16:
    case Format::u16:
      return 2;
    default:
      return 4;
  }
}

/// The order of the values of an image in memory. A stride of 0 means packed: channels of a pixel side by side, then
/// pixels, then rows. Strides may be negative; the offset is that of pixel (0, 0).
struct Layout {
  Format format = Format::f32;
  std::ptrdiff_t channel_stride = 0;  ///< bytes
  std::ptrdiff_t pixel_stride = 0;    ///< bytes
  std::ptrdiff_t row_stride = 0;      ///< bytes
  std::size_t offset = 0;             ///< bytes from the pointer or the start of the buffer
};

/// An image to read; owns nothing. Set `host` or `buffer`, or neither if the frame has no such image.
struct Image {
  const void* host = nullptr;
  cl_mem buffer = nullptr;
  Layout layout = {};

  explicit operator bool() const { return host != nullptr || buffer != nullptr; }
};

/// An image to write; owns nothing. It may be the same memory as an image to read, if the layout is the same.
struct OutputImage {
  void* host = nullptr;
  cl_mem buffer = nullptr;
  Layout layout = {};

  explicit operator bool() const { return host != nullptr || buffer != nullptr; }
};

/// The projection, in pixels of the frame: x to the right, y down, pixel (i, j) centred on (i + 0.5, j + 0.5).
/// A point at view depth z projects to center + focal_px * (X, Y) / z if perspective, and to
/// center + px_per_unit * (X, Y) if orthographic.
struct Camera {
  enum class Projection { perspective, orthographic };

  Projection projection = Projection::perspective;
  double scale_x = 0;   ///< focal length in px, or px per scene unit; > 0
  double scale_y = 0;   ///< differs from scale_x where pixels are not square
  double center_x = 0;  ///< px from the frame's left edge
  double center_y = 0;  ///< px from the frame's top edge

  static Camera perspective(double focal_x_px, double focal_y_px, double center_x_px, double center_y_px) {
    return {Projection::perspective, focal_x_px, focal_y_px, center_x_px, center_y_px};
  }
  static Camera orthographic(double px_per_unit_x, double px_per_unit_y) {
    return {Projection::orthographic, px_per_unit_x, px_per_unit_y, 0, 0};
  }

  bool operator==(const Camera&) const = default;
};

/// Another picture of the surfaces of a frame at the same moment, from a place that sees what the camera of the frame
/// does not: from behind, from a light, or a texture that was baked. All images have the view's size. Its resolution,
/// projection and exposure time may be any; its light is in the units of the frame's. Pixels whose values are not
/// finite count as background.
struct View {
  int width = 0;
  int height = 0;
  Image light = {};     ///< RGB, f16 or f32: as Frame::light
  Image albedo = {};    ///< RGB, f16 or f32: if the frame has one
  Image position = {};  ///< 3 channels, f16 or f32: of the surface, scene units, in any axes
  Image normal = {};    ///< 3 channels, f16 or f32, of any length, in the same axes: across the surface, outwards
  Image material = {};  ///< 1 channel, any format: as Frame::material, if the frame has it
  /// Row by row the 3 x 4 matrix that takes positions to the axes of the frame's camera: to the right, down, away from
  /// it, in the coordinates that Camera projects. A motion: no scale, no mirror.
  std::array<double, 12> to_camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

/// The largest value of light, of either sign. What is beyond counts as not finite.
inline constexpr float largest_light = 1e32F;

/// One G-buffer. All images have the frame's size. A pixel whose depth is not finite, not above 0 (perspective), 1e9
/// and more, nearer than 1e-15 mm (perspective) or further than 1e15 mm is background, and so is one whose light or
/// albedo is not finite: it neither gives nor takes light.
struct Frame {
  int width = 0;
  int height = 0;
  Image light = {};     ///< RGB, f16 or f32: diffuse light, with or without the albedo (Options::lighting)
  Image albedo = {};    ///< RGB, f16 or f32
  Image depth = {};     ///< 1 channel, f16 or f32: distance along the view axis, scene units
  Image material = {};  ///< 1 channel, any format: material id; a fractional id belongs to no material
  Image mask = {};      ///< 1 channel, f16 or f32: width of the profile, 0 (no scattering) .. 1 (the whole profile)
  /// 1 channel, f16 or f32: the share m of each pixel that its material covers, 0 (none: it does not scatter) .. 1. As
  /// only m of the light there is the material's own, a pixel gives light as m^2 of a surface; what is written is
  /// (1 - m) of the light as it was and m of that after scattering.
  Image matte = {};
  /// 3 channels, f16 or f32, of any length: across the surface, towards the camera, on axes to the right, down and away
  /// from it. Method::disc takes the plane of its discs from it; where it is not finite or faces away, from depth.
  /// Random walks take the curvature of the surface from it (Options::curvature); where it is not finite, there is
  /// none.
  Image normal = {};
  Image beauty = {};  ///< RGB, f16 or f32: the picture with all its light; needed for `result`
  Camera camera = {};
  double mm_per_unit = 1;  ///< millimetres per scene unit

  /// Surfaces that the camera does not see: light that enters there and leaves where it looks is added. The frame needs
  /// a depth then.
  std::span<const View> views = {};

  OutputImage scattered = {};  ///< RGB, f16 or f32: light after scattering, before the albedo is put back
  OutputImage result = {};     ///< RGB, f16 or f32: `beauty` with its diffuse light scattered
};

}  // namespace dermis
