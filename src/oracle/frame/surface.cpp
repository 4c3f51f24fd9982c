#include "oracle/frame/surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dermis/error.hpp"

namespace dermis::oracle {

namespace {

constexpr double background_depth = 1e9;                     // scene units; see Frame
constexpr double id_tolerance = static_cast<double>(1e-3F);  // see Frame::material

void check(const FrameImages& images, std::span<const Material> materials) {
  if (materials.empty()) throw Error(ErrorCode::usage, "materials", "none", "at least one");
  if (!is_there(images.material) && materials.size() > 1) {
    throw Error(ErrorCode::usage, "materials", std::to_string(materials.size()),
                "one, as the frame has no material ids");
  }
  const bool needs_albedo = std::any_of(materials.begin(), materials.end(),
                                        [](const Material& material) { return material.width_follows_albedo; });
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

bool is_surface(const FrameImages& images, const View& view, int x, int y) {
  if (is_there(images.depth)) {
    const double depth = images.depth(x, y);
    if (!std::isfinite(depth) || depth >= background_depth || (view.is_perspective() && depth <= 0)) return false;
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
  return m >= 0 && materials[m].width_follows_albedo && !has_albedo(images, x, y) ? -1 : m;
}

/// Returns s(A) of Christensen and Burley, Approximate Reflectance Profiles, 2015, eq. 6.
Bounded burley_scale(Bounded albedo) {
  const Bounded from_middle = albedo - as_float(0.8);
  return as_float(1.9) - albedo + exact(3.5) * from_middle * from_middle;
}

std::array<Bounded, 3> width_factor(const FrameImages& images, const Material& material, int x, int y) {
  const Bounded mask = exact(is_there(images.mask) ? std::min(images.mask(x, y), 1.0) : 1);
  if (!material.width_follows_albedo) return {mask, mask, mask};
  std::array<Bounded, 3> factor;
  for (int c = 0; c < 3; ++c) factor[c] = mask / burley_scale(exact(std::clamp(images.albedo(x, y, c), 0.0, 1.0)));
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

}  // namespace

Surface::Surface(const Frame& frame, const FrameImages& images, std::span<const Material> materials, bool sheared)
    : sheared_(sheared && is_there(images.depth)),
      width_(frame.width),
      height_(frame.height),
      view_(frame.camera, frame.mm_per_unit) {
  check(images, materials);
  pixels_.resize(static_cast<std::size_t>(width_) * height_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      SurfacePixel& pixel = pixels_[static_cast<std::size_t>(y) * width_ + x];
      pixel.material = material_at(images, view_, materials, x, y);
      if (pixel.material < 0) continue;
      pixel.covered = is_there(images.matte) ? std::min(images.matte(x, y), 1.0) : 1;
      pixel.bad = !is_finite_at(images.light, x, y) || !has_albedo(images, x, y);
      const Material& material = materials[pixel.material];
      const Bounded z_mm = is_there(images.depth) ? view_.depth_mm(images.depth(x, y)) : exact(0);
      pixel.position_mm = view_.position(x, y, z_mm);
      pixel.width_factor = width_factor(images, material, x, y);
      const Bounded spread = widest(pixel.width_factor, material.taps);
      for (const Axis axis : {horizontal, vertical}) {
        pixel.px_per_mm[axis] = view_.px_per_mm(axis, z_mm);
        pixel.effective_px_per_mm[axis] = pixel.px_per_mm[axis] * spread;
      }
      decide_wide(pixel, material.taps);
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
}

/// The differences of depth to both neighbours of the material along an axis, mm. If there is only one, both are the
/// difference to it.
struct Surface::DepthSteps {
  bool has_previous, has_next;
  Bounded backward, forward;
};

Surface::DepthSteps Surface::depth_steps(int x, int y, Axis axis) const {
  const int dx = axis == horizontal ? 1 : 0;
  const int dy = 1 - dx;
  const SurfacePixel& pixel = at(x, y);
  DepthSteps steps{shows(pixel.material, x - dx, y - dy), shows(pixel.material, x + dx, y + dy), exact(0), exact(0)};
  const Bounded z = pixel.position_mm[2];
  if (steps.has_next) steps.forward = at(x + dx, y + dy).position_mm[2] - z;
  if (steps.has_previous) steps.backward = z - at(x - dx, y - dy).position_mm[2];
  if (!steps.has_next) steps.forward = steps.backward;
  if (!steps.has_previous) steps.backward = steps.forward;
  return steps;
}

Bounded Surface::depth_slope(int x, int y, Axis axis) const {
  const auto [has_previous, has_next, backward, forward] = depth_steps(x, y, axis);
  if (!has_previous || !has_next) return forward;
  // The slope is continuous in both differences, so that a device that decides otherwise is off by no more than they
  // are.
  const Bounded smaller = std::abs(forward.value) < std::abs(backward.value) ? forward : backward;
  const bool same_sign = (forward.value > 0) == (backward.value > 0);
  return {same_sign ? smaller.value : 0, std::max(forward.error, backward.error)};
}

/// Returns how the difference of depth along one axis changes along the other one, mm; 0 without both pixels on the
/// diagonal.
Bounded Surface::cross_step(int x, int y, const DepthSteps& along_x, const DepthSteps& along_y) const {
  const SurfacePixel& pixel = at(x, y);
  if (!shows(pixel.material, x - 1, y - 1) || !shows(pixel.material, x + 1, y + 1)) return exact(0);
  const Bounded z = pixel.position_mm[2];
  const Bounded diagonal = (at(x + 1, y + 1).position_mm[2] - z) - (z - at(x - 1, y - 1).position_mm[2]);
  return exact(0.5) * (diagonal - (along_x.forward - along_x.backward) - (along_y.forward - along_y.backward));
}

// Along x the tangent is T = (size + ray g, ray' g, g), and its change per pixel is (2 size' g + ray h, ray' h, h),
// where g and h are the first and the second difference of depth, and size' is the change of the ray per pixel. Under a
// shear s, which moves s columns per row, g and h are the differences along (s, 1), and s times the tangent along x is
// added.
Bend Surface::bend(int x, int y, Axis axis, const BoundedShear& shear, float px_per_mm) const {
  const SurfacePixel& pixel = at(x, y);
  const DepthSteps steps = depth_steps(x, y, axis);
  Bounded g = exact(0.5) * (steps.forward + steps.backward);
  Bounded h = steps.forward - steps.backward;
  const Bounded side = axis == vertical ? shear.columns() : exact(0);
  if (!is_exactly(side, 0)) {
    const DepthSteps across = depth_steps(x, y, horizontal);
    g = g + side * (exact(0.5) * (across.forward + across.backward));
    h = h + side * (side * (across.forward - across.backward) + exact(2) * cross_step(x, y, across, steps));
  }
  Bounded length2 = g * g;
  Bounded growth = g * h;
  for (const Axis i : {horizontal, vertical}) {
    const Bounded ray = view_.is_perspective() ? pixel.position_mm[i] / pixel.position_mm[2] : exact(0);
    const Bounded pixels = i == axis ? exact(1) : side;
    const Bounded change = ray * g + pixels * view_.size_mm(i, pixel.position_mm[2]);
    const Bounded change_of_change = ray * h + exact(2) * pixels * view_.growth_mm(i, g);
    length2 = length2 + change * change;
    growth = growth + change * change_of_change;
  }
  const Bounded square = exact(px_per_mm) * exact(px_per_mm);
  return {square * rounded(length2, 2) - exact(1), square * rounded(growth, 2)};
}

// One pixel on the position changes by the pixel's size along the axis, and by what the ray runs over the change of
// depth.
Tangent Surface::tangent(int x, int y, Axis axis) const { return tangent(x, y, axis, depth_slope(x, y, axis)); }

Tangent Surface::tangent(int x, int y, Axis axis, Bounded slope) const {
  const SurfacePixel& pixel = at(x, y);
  Tangent change;
  change[2] = slope;
  for (const Axis i : {horizontal, vertical}) {
    const Bounded ray = view_.is_perspective() ? pixel.position_mm[i] / pixel.position_mm[2] : exact(0);
    change[i] = ray * change[2];
    if (i == axis) change[i] = change[i] + view_.size_mm(i, pixel.position_mm[2]);
  }
  return change;
}

Bounded patch_area(const Tangent& x, const Tangent& y) {
  Bounded sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Bounded part = x[j] * y[k] - x[k] * y[j];
    sum = sum + part * part;
  }
  return square_root(rounded(sum));
}

BoundedShear Surface::shear(int x, int y) const {
  if (!sheared_) return {};
  return whole_shear(shear_between(tangent(x, y, horizontal), tangent(x, y, vertical)));
}

Bounded Surface::segment(int x, int y, Axis axis) const {
  Tangent along = tangent(x, y, axis);
  if (axis == vertical && sheared_) {
    const Tangent across = tangent(x, y, horizontal);
    const Bounded shear = shear_between(across, along);
    for (int i = 0; i < 3; ++i) along[i] = along[i] + shear * across[i];
  }
  Bounded sum = exact(0);
  for (const Bounded part : along) sum = sum + part * part;
  return square_root(sum);
}

Picture Surface::touched() const {
  Picture touched(width_, height_, 1);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) touched(x, y) = at(x, y).takes_light() ? 1 : 0;
  }
  return touched;
}

}  // namespace dermis::oracle
