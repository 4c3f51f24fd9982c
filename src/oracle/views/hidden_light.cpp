#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/surface.hpp"
#include "oracle/math/projection.hpp"
#include "oracle/math/vec3.hpp"
#include "oracle/views/patches.hpp"
#include "oracle/views/walk_crossing.hpp"

namespace dermis::oracle {

namespace {

/// The share of the light within the reach of a material, and the largest part of a patch beside that.
constexpr double share_within_reach = 0.997;
constexpr double parts_per_reach = 80;
constexpr int most_parts = 4;

/// What a patch has in common with the pixel of another view.
constexpr double least_agreement = 0.2;
constexpr double half_pixel = 0.55;

/// A part of a patch.
struct Sample {
  Vec3 position;
  Vec3 normal;
  Vec3 light;
  double area_mm2;
};

/// How far light of a material reaches, mm.
double reach_of(const Material& material) {
  double reach = 0;
  for (int c = 0; c < 3; ++c) {
    double low = 0;
    double high = 1;
    while (material.cdf(c, high) < share_within_reach) high *= 2;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      (material.cdf(c, middle) < share_within_reach ? low : high) = middle;
    }
    reach = std::max(reach, high);
  }
  return reach;
}

/// How far a place is from the middle of a patch, where 1 is its edge.
double distance_in(const ViewPatch& patch, const Vec3& place) {
  const Vec3 way = difference(place, patch.position);
  const Vec3 normal = cross(patch.way[0], patch.way[1]);
  const double area2 = dot(normal, normal);
  // Cramer's rule, in the plane of the patch.
  const double u = dot(cross(way, patch.way[1]), normal) / area2;
  const double v = dot(cross(patch.way[0], way), normal) / area2;
  return std::max(std::abs(u), std::abs(v)) / half_pixel;
}

/// The patches per mm^2 with which a view shows the place of another's patch; 0 if it does not.
double density_at(const std::vector<ViewPatch>& view, const ViewPatch& patch) {
  double nearest = 1;
  double density = 0;
  for (const ViewPatch& other : view) {
    if (other.material != patch.material || dot(other.normal, patch.normal) < least_agreement) continue;
    const double distance = distance_in(other, patch.position);
    const double height = std::abs(dot(difference(patch.position, other.position), other.normal));
    if (distance > nearest || height > std::sqrt(other.area_mm2())) continue;
    nearest = distance;
    density = 1 / other.area_mm2();
  }
  return density;
}

void split(const ViewPatch& patch, double area_mm2, double reach_mm, std::vector<Sample>& samples) {
  const double sides = std::ceil(std::sqrt(patch.area_mm2()) * parts_per_reach / reach_mm);
  const int parts = static_cast<int>(std::clamp(sides, 1.0, static_cast<double>(most_parts)));
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      const Vec3 offset =
          sum(scaled(patch.way[0], (i + 0.5) / parts - 0.5), scaled(patch.way[1], (j + 0.5) / parts - 0.5));
      samples.push_back({sum(patch.position, offset), patch.normal, patch.light, area_mm2 / parts / parts});
    }
  }
}

/// The hidden samples of each material.
std::vector<std::vector<Sample>> hidden_samples(const Frame& frame, const Surface& surface,
                                                std::span<const Material> materials, const Options& options) {
  std::vector<std::vector<ViewPatch>> views;
  for (const dermis::View& view : frame.views) views.push_back(patches_of(view, frame, surface, materials, options));
  std::vector<double> reach_mm;
  for (const Material& material : materials) reach_mm.push_back(reach_of(material));
  std::vector<std::vector<Sample>> samples(materials.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (const ViewPatch& patch : views[v]) {
      if (!patch.is_hidden) continue;
      double density = 1 / patch.area_mm2();
      for (std::size_t other = 0; other < views.size(); ++other) {
        if (other != v) density += density_at(views[other], patch);
      }
      split(patch, 1 / density, reach_mm[patch.material], samples[patch.material]);
    }
  }
  return samples;
}

/// A point that gathers light.
struct Target {
  Vec3 position;
  std::array<Vec3, 3> axes;  ///< the normal, and two across it
};

Target target_at(const Surface& surface, int x, int y) {
  const auto& at = surface.at(x, y).position_mm;
  std::array<Vec3, 2> tangents;
  for (const Axis axis : {horizontal, vertical}) {
    tangents[axis] = surface.view().tangent(axis, x + 0.5, y + 0.5, at[2].value, surface.depth_slope(x, y, axis).value);
  }
  return {{at[0].value, at[1].value, at[2].value}, axes_about(unit(cross(tangents[1], tangents[0])))};
}

double area_of(const std::vector<Sample>& samples) {
  double area_mm2 = 0;
  for (const Sample& sample : samples) area_mm2 += sample.area_mm2;
  return area_mm2;
}

/// How light crosses each material, if its profile is that of random walks.
std::vector<std::optional<WalkCrossing>> walks_of(std::span<const Material> materials) {
  std::vector<std::optional<WalkCrossing>> walks(materials.size());
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].walk) walks[m].emplace(materials[m], reach_of(materials[m]));
  }
  return walks;
}

}  // namespace

HiddenLight hidden_light(const Frame& frame, std::span<const Material> materials, const Options& options) {
  const FrameImages images = read_images(frame);
  const Surface surface(frame, images, materials, Light(images, options), false);
  const std::vector<std::vector<Sample>> samples = hidden_samples(frame, surface, materials, options);
  const Picture none(frame.width, frame.height, 3);
  HiddenLight hidden{none, none, none, {}};
  for (const std::vector<Sample>& its : samples) hidden.area_mm2.push_back(area_of(its));
  const std::vector<std::optional<WalkCrossing>> walks = walks_of(materials);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const SurfacePixel& pixel = surface.at(x, y);
      if (!pixel.takes_light()) continue;
      const Material& material = materials[pixel.material];
      const Target target = target_at(surface, x, y);
      for (const Sample& sample : samples[pixel.material]) {
        const Vec3 way = difference(sample.position, target.position);
        const double r_mm = std::sqrt(dot(way, way) + 0.08 * sample.area_mm2);
        double area = sample.area_mm2;
        if (material.is_projected) area *= projection_factor(target.axes, sample.normal, way, sample.area_mm2);
        for (int c = 0; c < 3; ++c) {
          const double k = pixel.width_factor[c].value;
          const double weight = area * material.radial(c, r_mm / k) / (k * k);
          hidden.weight(x, y, c) += weight;
          if (walks[pixel.material]) {
            const WalkCrossing::Gain gain = walks[pixel.material]->gain(c, target.axes[0], sample.normal, way, r_mm);
            hidden.light(x, y, c) += weight * sample.light[c] * gain.slab;
            hidden.bent(x, y, c) += weight * sample.light[c] * gain.bend;
          } else {
            hidden.light(x, y, c) += weight * sample.light[c];
          }
        }
      }
    }
  }
  return hidden;
}

}  // namespace dermis::oracle
