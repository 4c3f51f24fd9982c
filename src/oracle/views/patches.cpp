#include "oracle/views/patches.hpp"

#include <algorithm>
#include <cmath>

#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"

namespace dermis::oracle {

namespace {

/// How far from the plane of a patch, in sizes of a pixel of the frame, what the camera sees is the same surface.
constexpr double on_plane_px = 1.5;

/// A pixel that spans more than so many times the way of the usual one counts as that long.
constexpr double longest_way = 12.5;

/// A pixel of a view, mm, in the axes of the frame's camera.
struct Pixel {
  Vec3 position;
  Vec3 normal;
  int material = -1;
};

class ViewPixels {
 public:
  ViewPixels(const dermis::View& view, double mm_per_unit, std::span<const Material> materials)
      : width_(view.width), height_(view.height) {
    const Picture position = read_image(view.position, width_, height_, 3, "position");
    const Picture normal = read_image(view.normal, width_, height_, 3, "normal");
    const Picture id = read_image(view.material, width_, height_, 1, "material");
    const auto& m = view.to_camera;
    const auto turned = [&](const Vec3& v) {
      return Vec3{m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
                  m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
    };
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const Vec3 moved = sum(turned(vector_at(position, x, y)), {m[3], m[7], m[11]});
        Pixel pixel{scaled(moved, mm_per_unit), unit(turned(vector_at(normal, x, y)))};
        if (is_finite(pixel.position) && is_finite(pixel.normal))
          pixel.material = is_there(id) ? index_of(id(x, y), materials) : 0;
        pixels_.push_back(pixel);
      }
    }
  }

  const Pixel& at(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }

  /// The way along the surface to the next pixel: the mean of those to it and from the last one, without the one that
  /// leads to another sheet, as it is more than twice as long. 0 if neither neighbour continues the surface.
  Vec3 way(int x, int y, Axis axis) const {
    std::vector<Vec3> ways;
    for (const int step : {-1, 1}) {
      const int u = x + (axis == horizontal ? step : 0);
      const int v = y + (axis == vertical ? step : 0);
      if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
      if (at(u, v).material != at(x, y).material || dot(at(u, v).normal, at(x, y).normal) <= 0) continue;
      const Vec3 straight = scaled(difference(at(u, v).position, at(x, y).position), step);
      ways.push_back(difference(straight, scaled(at(x, y).normal, dot(straight, at(x, y).normal))));
    }
    if (ways.empty()) return {};
    const double shorter = std::min(length(ways.front()), length(ways.back()));
    std::erase_if(ways, [&](const Vec3& its) { return length(its) > 2 * shorter; });
    return scaled(sum(ways.front(), ways.back()), 0.5);
  }

 private:
  static int index_of(double id, std::span<const Material> materials) {
    const auto found = std::find_if(materials.begin(), materials.end(),
                                    [&](const Material& its) { return std::abs(id - its.id) <= 1e-3; });
    return found == materials.end() ? -1 : static_cast<int>(found - materials.begin());
  }

  int width_;
  int height_;
  std::vector<Pixel> pixels_;
};

/// Whether the frame's camera looks at a point: one of the 3 x 3 pixels about it shows the plane of the patch there.
bool is_seen(const Pixel& point, const Frame& frame, const Surface& surface) {
  const View& camera = surface.view();
  const double z = point.position[2];
  if (camera.is_perspective() && z <= 0) return false;
  const Vec3 ray = camera.is_perspective() ? point.position : Vec3{0, 0, 1};
  if (dot(ray, point.normal) >= 0) return false;
  const double size_x = camera.size_mm(horizontal, exact(z)).value;
  const double size_y = camera.size_mm(vertical, exact(z)).value;
  const Vec3 corner = camera.unproject(0, 0, z);
  const double px = std::floor((point.position[0] - corner[0]) / size_x);
  const double py = std::floor((point.position[1] - corner[1]) / size_y);
  if (!(px >= 1 && py >= 1 && px < frame.width - 1 && py < frame.height - 1)) return false;
  for (int y = static_cast<int>(py) - 1; y <= static_cast<int>(py) + 1; ++y) {
    for (int x = static_cast<int>(px) - 1; x <= static_cast<int>(px) + 1; ++x) {
      if (!surface.shows(point.material, x, y)) continue;
      const auto& there = surface.at(x, y).position_mm;
      const Vec3 way = difference({there[0].value, there[1].value, there[2].value}, point.position);
      if (std::abs(dot(way, point.normal)) < on_plane_px * std::max(size_x, size_y)) return true;
    }
  }
  return false;
}

/// Where one way is not known the surface is taken to be as long there as along the other, at a right angle to it.
void complete(ViewPatch& patch) {
  for (const int axis : {0, 1}) {
    if (length(patch.way[axis]) == 0) patch.way[axis] = cross(patch.normal, patch.way[1 - axis]);
  }
}

double shorter_way(const ViewPatch& patch) { return std::min(length(patch.way[0]), length(patch.way[1])); }

void shorten_ways(std::vector<ViewPatch>& patches) {
  std::vector<double> ways;
  ways.reserve(patches.size());
  for (const ViewPatch& patch : patches) ways.push_back(shorter_way(patch));
  std::sort(ways.begin(), ways.end());
  for (ViewPatch& patch : patches) {
    for (Vec3& way : patch.way) way = scaled(way, std::min(1.0, longest_way * ways[ways.size() / 2] / length(way)));
  }
}

bool can_be_added(const Vec3& light) {
  return std::all_of(light.begin(), light.end(),
                     [](double value) { return std::abs(value) <= static_cast<double>(largest_light); });
}

}  // namespace

std::vector<ViewPatch> patches_of(const dermis::View& view, const Frame& frame, const Surface& surface,
                                  std::span<const Material> materials, const Options& options) {
  const ViewPixels pixels(view, frame.mm_per_unit, materials);
  FrameImages images;
  images.light = read_image(view.light, view.width, view.height, 3, "light");
  images.albedo = read_image(view.albedo, view.width, view.height, 3, "albedo");
  const Light light(images, options);
  std::vector<ViewPatch> patches;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const Pixel& pixel = pixels.at(x, y);
      const Vec3 its_light{light.filtered(x, y, 0).value, light.filtered(x, y, 1).value, light.filtered(x, y, 2).value};
      if (pixel.material < 0 || !can_be_added(its_light) || !can_be_added(vector_at(images.light, x, y))) continue;
      if (is_there(images.albedo) && !is_finite(vector_at(images.albedo, x, y))) continue;
      ViewPatch patch{pixel.position, pixel.normal, {pixels.way(x, y, horizontal), pixels.way(x, y, vertical)},
                      pixel.material, its_light,    !is_seen(pixel, frame, surface)};
      complete(patch);
      if (shorter_way(patch) > 0) patches.push_back(patch);
    }
  }
  shorten_ways(patches);
  std::erase_if(patches, [](const ViewPatch& patch) { return !(patch.area_mm2() > 0); });
  return patches;
}

}  // namespace dermis::oracle
