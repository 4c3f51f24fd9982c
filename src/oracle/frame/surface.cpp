#include "oracle/frame/surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dermis/error.hpp"

namespace dermis::oracle {

namespace {

constexpr double background_depth = 1e9;                    // scene units; see Frame
constexpr double nearest_mm = static_cast<double>(1e-15F);  // under a perspective camera
constexpr double furthest_mm = static_cast<double>(1e15F);
constexpr double id_tolerance = static_cast<double>(1e-3F);  // see Frame::material

void check(const FrameImages& images, std::span<const Material> materials) {
  if (materials.empty()) throw Error(ErrorCode::usage, "materials", "none", "at least one");
  if (!is_there(images.material) && materials.size() > 1) {
    throw Error(ErrorCode::usage, "materials", std::to_string(materials.size()),
                "one, as the frame has no material ids");
  }
  const bool needs_albedo = std::any_of(materials.begin(), materials.end(),
                                        [](const Material& material) { return material.albedo_width.has_value(); });
  if (needs_albedo && !is_there(images.albedo)) {
    throw Error(ErrorCode::role_missing, "frame.albedo", "no image", "the albedo that a profile's width follows");
  }
}

bool is_finite_at(const Picture& picture, int x, int y) {
  for (int c = 0; c < picture.channels; ++c) {
    if (!std::isfinite(picture(x, y, c))) return false;
  }
  return true;
}

/// Light as it is in the image, and as it is scattered, is within what can be added up.
bool can_be_added(const FrameImages& images, const Light& light, int x, int y) {
  constexpr auto most = static_cast<double>(largest_light);
  for (int c = 0; c < 3; ++c) {
    if (!(std::abs(images.light(x, y, c)) <= most && std::abs(light.filtered(x, y, c).value) <= most)) return false;
  }
  return true;
}

bool is_surface(const FrameImages& images, const View& view, int x, int y) {
  if (is_there(images.depth)) {
    const double depth = images.depth(x, y);
    const double z_mm = view.depth_mm(depth).value;
    if (!(depth < background_depth && z_mm >= (view.is_perspective() ? nearest_mm : -furthest_mm) &&
          z_mm <= furthest_mm)) {
      return false;
    }
  }
  const auto is_share = [&](const Picture& share) {
    return !is_there(share) || (std::isfinite(share(x, y)) && share(x, y) > 0);
  };
  return is_share(images.mask) && is_share(images.matte);
}

bool has_albedo(const FrameImages& images, int x, int y) {
  return !is_there(images.albedo) || is_finite_at(images.albedo, x, y);
}

int material_by_id(const FrameImages& images, std::span<const Material> materials, int x, int y) {
  if (!is_there(images.material)) return 0;
  const double id = images.material(x, y);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (std::abs(id - materials[m].id) <= id_tolerance) return static_cast<int>(m);
  }
  return -1;
}

/// Where the width follows an albedo that is not finite the kernel is unknown, so that the pixel has no material.
int material_at(const FrameImages& images, const View& view, std::span<const Material> materials, int x, int y) {
  if (!is_surface(images, view, x, y)) return -1;
  const int m = material_by_id(images, materials, x, y);
  return m >= 0 && materials[m].albedo_width && !has_albedo(images, x, y) ? -1 : m;
}

/// Returns c_0 + A (c_1 + A (c_2 + ...)), with coefficients rounded to float32.
template <std::size_t count>
Bounded polynomial(const std::array<double, count>& coefficients, Bounded albedo) {
  Bounded sum = as_float(coefficients[count - 1]);
  for (std::size_t i = count - 1; i-- > 0;) sum = as_float(coefficients[i]) + albedo * sum;
  return sum;
}

std::array<Bounded, 3> width_factor(const FrameImages& images, const Material& material, int x, int y) {
  const Bounded mask = exact(is_there(images.mask) ? std::min(images.mask(x, y), 1.0) : 1);
  if (!material.albedo_width) return {mask, mask, mask};
  std::array<Bounded, 3> factor;
  for (int c = 0; c < 3; ++c) {
    const Bounded albedo = exact(std::clamp(images.albedo(x, y, c), 0.0, 1.0));
    factor[c] = mask * (polynomial(material.albedo_width->numerator, albedo) /
                        polynomial(material.albedo_width->denominator, albedo));
  }
  return factor;
}

Bounded widest(const std::array<Bounded, 3>& width_factor, const Taps& taps) {
  Bounded result;
  for (int c = 0; c < 3; ++c) result = larger(result, width_factor[c] * exact(taps.relative_width[c]));
  return result;
}

void decide_wide(SurfacePixel& pixel, const Taps& taps) {
  const Bounded radius_px =
      larger(pixel.effective_px_per_mm[horizontal], pixel.effective_px_per_mm[vertical]) * as_float(taps.radius_mm);
  const auto narrow = static_cast<double>(Taps::min_radius_px);
  pixel.wide = radius_px.value >= narrow;
  pixel.wide_unsure = radius_px.low() < narrow && radius_px.high() >= narrow;
}

/// A pixel without its segments, for which its neighbours have to be known.
SurfacePixel pixel_at(const FrameImages& images, const View& view, std::span<const Material> materials,
                      const Light& light, int x, int y) {
  SurfacePixel pixel;
  pixel.material = material_at(images, view, materials, x, y);
  if (pixel.material < 0) return pixel;
  pixel.covered = is_there(images.matte) ? std::min(images.matte(x, y), 1.0) : 1;
  pixel.bad = !can_be_added(images, light, x, y) || !has_albedo(images, x, y);
  const Material& material = materials[pixel.material];
  const Bounded z_mm = is_there(images.depth) ? view.depth_mm(images.depth(x, y)) : exact(0);
  pixel.position_mm = view.position(x, y, z_mm);
  pixel.slant_mm = view.slant_mm(x, y, z_mm);
  pixel.width_factor = width_factor(images, material, x, y);
  const Bounded spread = widest(pixel.width_factor, material.taps);
  for (const Axis axis : {horizontal, vertical}) {
    pixel.px_per_mm[axis] = view.px_per_mm(axis, z_mm);
    pixel.effective_px_per_mm[axis] = pixel.px_per_mm[axis] * spread;
  }
  decide_wide(pixel, material.taps);
  return pixel;
}

}  // namespace

Surface::Surface(const Frame& frame, const FrameImages& images, std::span<const Material> materials, const Light& light,
                 bool sheared)
    : sheared_(sheared && is_there(images.depth)),
      width_(frame.width),
      height_(frame.height),
      view_(frame.camera, frame.mm_per_unit) {
  check(images, materials);
  pixels_.resize(static_cast<std::size_t>(width_) * height_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      pixels_[static_cast<std::size_t>(y) * width_ + x] = pixel_at(images, view_, materials, light, x, y);
    }
  }
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      SurfacePixel& pixel = pixels_[static_cast<std::size_t>(y) * width_ + x];
      if (pixel.material < 0) continue;
      for (const Axis axis : {horizontal, vertical})
        pixel.segment_mm[axis] = exact(pixel.covered) * exact(pixel.covered) * segment(x, y, axis);
    }
  }
  for (int y = 0; sheared_ && y < height_; ++y) {
    for (int run = 0; run < runs_per_row(); ++run) shears_.push_back(run_shear(run, y));
  }
}

Bounded Surface::depth_slope(int x, int y, Axis axis) const {
  const int dx = axis == horizontal ? 1 : 0;
  const int dy = 1 - dx;
  const SurfacePixel& pixel = at(x, y);
  const bool has_previous = shows(pixel.material, x - dx, y - dy);
  const bool has_next = shows(pixel.material, x + dx, y + dy);
  const Bounded z = pixel.position_mm[2];
  const Bounded forward = has_next ? at(x + dx, y + dy).position_mm[2] - z : exact(0);
  const Bounded backward = has_previous ? z - at(x - dx, y - dy).position_mm[2] : exact(0);
  if (!has_previous || !has_next) return has_next ? forward : backward;
  // The slope is continuous in both differences, so that a device that decides otherwise is off by no more than they
  // are.
  const Bounded smaller = std::abs(forward.value) < std::abs(backward.value) ? forward : backward;
  const bool same_sign = (forward.value > 0) == (backward.value > 0);
  return {same_sign ? smaller.value : 0, std::max(forward.error, backward.error)};
}

/// Returns the change of x or y with depth along the ray through a pixel.
Bounded Surface::ray(int x, int y, Axis axis) const {
  const auto& position_mm = at(x, y).position_mm;
  return view_.is_perspective() ? position_mm[axis] / position_mm[2] : exact(0);
}

// One pixel on the position changes by the pixel's size along the axis, and by what the ray runs over the change of
// depth.
Tangent Surface::tangent(int x, int y, Axis axis, Bounded slope) const {
  Tangent change;
  change[2] = slope;
  for (const Axis i : {horizontal, vertical}) {
    change[i] = ray(x, y, i) * slope;
    if (i == axis) change[i] = change[i] + view_.size_mm(i, at(x, y).position_mm[2]);
  }
  return change;
}

/// Returns the normal of the patch of surface in a pixel, as long as its area, mm^2. A device may cross the tangents or
/// multiply their product out, which cancels elsewhere, so that each part has the larger error of the two.
Tangent Surface::normal(int x, int y) const {
  const Bounded slope_x = depth_slope(x, y, horizontal);
  const Bounded slope_y = depth_slope(x, y, vertical);
  const Bounded size_x = view_.size_mm(horizontal, at(x, y).position_mm[2]);
  const Bounded size_y = view_.size_mm(vertical, at(x, y).position_mm[2]);
  const Tangent multiplied_out{
      slope_x * size_y, slope_y * size_x,
      size_x * (size_y + ray(x, y, vertical) * slope_y) + size_y * ray(x, y, horizontal) * slope_x};
  Tangent normal = cross(tangent(x, y, horizontal, slope_x), tangent(x, y, vertical, slope_y));
  for (std::size_t i = 0; i < 3; ++i) normal[i].error = std::max(normal[i].error, multiplied_out[i].error);
  return normal;
}

Bounded patch_area(const Tangent& x, const Tangent& y) { return length(cross(x, y)); }

BoundedShear Surface::run_shear(int run, int y) const {
  std::vector<BoundedShear> shears;
  for (int x = shear_run_px * run; x < std::min(shear_run_px * (run + 1), width_); ++x) {
    if (at(x, y).material < 0) continue;
    shears.push_back(whole_shear(shear_between(tangent(x, y, horizontal), tangent(x, y, vertical))));
  }
  return damped_mean(shears);
}

BoundedShear Surface::shear(int x, int y) const {
  if (!sheared_) return {};
  return shears_[static_cast<std::size_t>(y) * runs_per_row() + x / shear_run_px];
}

// Across x the patch of a pixel is as long as its area over its length along x, whatever the angle of its sides.
Bounded Surface::segment(int x, int y, Axis axis) const {
  if (axis == horizontal || !sheared_) return length(tangent(x, y, axis));
  return length(normal(x, y)) / length(tangent(x, y, horizontal));
}

// With e = |P|^2 / z the squared distance is (z - z') (e - e') + z z' |P / z - P' / z'|^2, and if orthographic
// (z - z')^2 + (x - x')^2 + (y - y')^2.
Bounded Surface::distance2_mm2(int x, int y, int other_x, int other_y) const {
  const SurfacePixel& a = at(x, y);
  const SurfacePixel& b = at(other_x, other_y);
  if (&a == &b) return exact(0);
  const Bounded across2 = view_.across2_mm2(other_x - x, other_y - y, a.position_mm[2], b.position_mm[2]);
  // Both products and their sum may be flushed to zero.
  return flushed((b.position_mm[2] - a.position_mm[2]) * (b.slant_mm - a.slant_mm) + across2, 3);
}

Picture Surface::touched() const {
  Picture touched(width_, height_, 1);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) touched(x, y) = at(x, y).takes_light() ? 1 : 0;
  }
  return touched;
}

}  // namespace dermis::oracle
