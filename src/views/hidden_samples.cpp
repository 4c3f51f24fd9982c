#include "views/hidden_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

namespace dermis {

namespace {

/// The side of a cell, as a share of the reach.
constexpr double cell_side = 1.0 / 5;
/// How samples are joined, on each level but the first: so many cubes along an edge of a cell have theirs joined, from
/// those of the level before; and from such a distance on, as a share of the reach, they count instead of finer ones,
/// from half of it on in part.
struct Joining {
  std::array<int, HIDDEN_LEVELS - 1> cubes;
  std::array<double, HIDDEN_LEVELS - 1> from;
};
constexpr Joining joining = {{4, 2}, {0.15, 0.4}};
/// A projected profile is much steeper where it looks along a plane.
constexpr Joining joining_projected = {{8, 4}, {0.2, 0.6}};

const Joining& joining_of(const params::HiddenMaterial& material) {
  return material.crossing == CROSSING_PROJECTED ? joining_projected : joining;
}

/// A pixel is split until its parts are no larger than this share of the reach, but into 4 x 4 at most.
constexpr double largest_part = 1.0 / 80;
constexpr int most_parts = 4;

/// A pixel that spans more than so many times the way of the usual one is seen too flatly for its area to be known.
constexpr double longest_way = 12.5;

/// A patch lies in the pixel of another view if their normals are within 78 degrees, its middle is no farther from that
/// of the pixel than so many times the ways to the next pixels (with some room, as a surface bends), and no farther
/// from its plane than its side.
constexpr double least_agreement = 0.2;
constexpr double half_pixel = 0.55;

using Vector = std::array<double, 3>;

Vector vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector sum(const Vector& a, const Vector& b, double factor) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
double length(const Vector& v) { return std::sqrt(dot(v, v)); }

/// A pixel of a view whose area is known.
struct Patch {
  Vector at, normal, along_x, along_y;
  double area_mm2;
  int material;
  bool is_hidden;
  Vector light;
};

/// Where the way along one axis is not known, the surface is as long there as across it.
void complete_ways(Patch& patch) {
  const double x = length(patch.along_x);
  const double y = length(patch.along_y);
  const auto across = [&](const Vector& way) { return cross(patch.normal, way); };
  if (x == 0 && y > 0) patch.along_x = across(patch.along_y);
  if (y == 0 && x > 0) patch.along_y = across(patch.along_x);
}

std::vector<Patch> patches_of(const ViewPixels& view) {
  std::vector<Patch> patches;
  std::vector<double> ways;
  for (const params::ViewPixel& pixel : view) {
    Patch patch{
        vector_of(pixel.position), vector_of(pixel.normal),   vector_of(pixel.along_x), vector_of(pixel.along_y), 0,
        pixel.material - 1,        pixel.place != PLACE_SEEN, vector_of(pixel.light)};
    complete_ways(patch);
    const double way = std::min(length(patch.along_x), length(patch.along_y));
    if (!(way > 0)) continue;
    ways.push_back(way);
    patches.push_back(patch);
  }
  if (patches.empty()) return patches;
  const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
  std::nth_element(ways.begin(), middle, ways.end());
  for (Patch& patch : patches) {
    for (Vector* way : {&patch.along_x, &patch.along_y}) {
      const double too_long = length(*way) / (longest_way * *middle);
      if (too_long > 1) *way = {(*way)[0] / too_long, (*way)[1] / too_long, (*way)[2] / too_long};
    }
    patch.area_mm2 = length(cross(patch.along_x, patch.along_y));
  }
  std::erase_if(patches, [](const Patch& patch) { return !(patch.area_mm2 > 0); });
  return patches;
}

/// A cube of a grid.
using Cube = std::array<std::int32_t, 3>;

Cube cube_of(const Vector& at, double side) {
  const auto index = [&](double value) {
    return static_cast<std::int32_t>(std::clamp(std::floor(value / side), -1e9, 1e9));
  };
  return {index(at[0]), index(at[1]), index(at[2])};
}

struct CubeHash {
  std::size_t operator()(const Cube& cube) const {
    std::uint64_t hash = 0;
    for (const std::int32_t index : cube) hash = (hash ^ static_cast<std::uint32_t>(index)) * 0x9e3779b97f4a7c15U;
    return static_cast<std::size_t>(hash ^ (hash >> 32U));
  }
};

/// How far a point of a patch's plane is from its middle, in halves of the patch: up to 1 it lies in the patch.
double halves_from_middle(const Patch& patch, const Vector& way) {
  const double xx = dot(patch.along_x, patch.along_x);
  const double xy = dot(patch.along_x, patch.along_y);
  const double yy = dot(patch.along_y, patch.along_y);
  const double x = dot(patch.along_x, way);
  const double y = dot(patch.along_y, way);
  const double determinant = xx * yy - xy * xy;
  return std::max(std::abs(yy * x - xy * y), std::abs(xx * y - xy * x)) / (half_pixel * determinant);
}

/// Finds what a view shows at a place.
class PatchGrid {
 public:
  explicit PatchGrid(const std::vector<Patch>& patches) : patches_(patches) {
    for (const Patch& patch : patches) {
      side_ = std::max(side_, half_pixel * (length(patch.along_x) + length(patch.along_y)));
    }
    for (std::size_t i = 0; i < patches.size(); ++i) cubes_[cube_of(patches[i].at, side_)].push_back(i);
  }

  /// Samples per mm^2 that the view has where a patch of another one lies; 0 if it does not show the place.
  double density_at(const Patch& patch) const {
    const Patch* nearest = nullptr;
    double least = 1;
    const Cube middle = cube_of(patch.at, side_);
    for (std::int32_t i = 0; i < 27; ++i) {
      const auto found = cubes_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (found == cubes_.end()) continue;
      for (const std::size_t index : found->second) {
        const Patch& other = patches_[index];
        if (other.material != patch.material || dot(other.normal, patch.normal) < least_agreement) continue;
        const Vector way = sum(patch.at, other.at, -1);
        const double halves = halves_from_middle(other, way);
        if (halves > least || std::abs(dot(way, other.normal)) > std::sqrt(other.area_mm2)) continue;
        least = halves;
        nearest = &other;
      }
    }
    return nearest != nullptr ? 1 / nearest->area_mm2 : 0;
  }

 private:
  const std::vector<Patch>& patches_;
  double side_ = 0;
  std::unordered_map<Cube, std::vector<std::size_t>, CubeHash> cubes_;
};

/// A patch of hidden surface, with the part of its area that it stands for.
struct HiddenPatch {
  const Patch* patch;
  double area_mm2;
};

/// Hidden surface that stands for an area. The normal of joined samples is their mean, which is shorter than 1.
struct Sample {
  Vector at, normal, light;
  double area_mm2;
};

/// Into so many parts along an edge a patch is split, until they are no larger than a length.
int parts_of(const Patch& patch, double largest_mm) {
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(patch.area_mm2) / largest_mm)), 1, most_parts);
}

void split(const HiddenPatch& its, double largest_mm, std::vector<Sample>& samples) {
  const Patch& patch = *its.patch;
  const int parts = parts_of(patch, largest_mm);
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      const auto offset = [&](int k) { return (k + 0.5) / parts - 0.5; };
      const Vector at = sum(sum(patch.at, patch.along_x, offset(i)), patch.along_y, offset(j));
      samples.push_back({at, patch.normal, patch.light, its.area_mm2 / (parts * parts)});
    }
  }
}

void store(const Vector& from, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

params::HiddenSample params_of(const Sample& sample) {
  params::HiddenSample result{};
  store(sample.at, result.position);
  store(sample.light, result.light);
  store(sum({}, sample.normal, 1 / length(sample.normal)), result.normal);
  result.area_mm2 = static_cast<float>(sample.area_mm2);
  result.parts = 1;
  return result;
}

/// The parts are made in the kernel, for there are many.
params::HiddenSample params_of(const HiddenPatch& its, double reach_mm) {
  const Patch& patch = *its.patch;
  const int parts = parts_of(patch, largest_part * reach_mm);
  params::HiddenSample result = params_of(Sample{patch.at, patch.normal, patch.light, its.area_mm2 / (parts * parts)});
  result.parts = parts;
  if (parts == 1) return result;
  store(sum({}, patch.along_x, 0.5 / parts), result.half_x);
  store(sum({}, patch.along_y, 0.5 / parts), result.half_y);
  result.radius_mm = static_cast<float>((length(patch.along_x) + length(patch.along_y)) / 2);
  return result;
}

/// The axis that a normal is nearest to, with its sign: samples of both sides of a thin part stay apart.
int side_of(const Vector& normal) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
  }
  return 2 * axis + (normal[axis] > 0 ? 1 : 0);
}

/// Joins the samples of each small cube and side to one, at their mean place with their mean light and normal. The cell
/// has so many small cubes along an edge; what sticks out of it, as part of a pixel, counts to those at its faces.
std::vector<Sample> joined(std::span<const Sample> samples, const Cube& cell, double cell_mm, int cubes) {
  std::vector<std::uint64_t> sorted;  // by cube and side, which are above the number of the sample
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      const double within = std::floor((samples[i].at[k] / cell_mm - cell[k]) * cubes);
      key = key * cubes + static_cast<std::uint64_t>(std::clamp(within, 0.0, cubes - 1.0));
    }
    sorted.push_back((key * 6 + side_of(samples[i].normal)) << 32U | i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Sample> result;
  for (std::size_t i = 0; i < sorted.size();) {
    Sample all{};
    const std::uint64_t key = sorted[i] >> 32U;
    for (; i < sorted.size() && sorted[i] >> 32U == key; ++i) {
      const Sample& one = samples[sorted[i] & 0xffffffffU];
      all.at = sum(all.at, one.at, one.area_mm2);
      all.light = sum(all.light, one.light, one.area_mm2);
      all.normal = sum(all.normal, one.normal, one.area_mm2);
      all.area_mm2 += one.area_mm2;
    }
    for (int k = 0; k < 3; ++k) {
      all.at[k] /= all.area_mm2;
      all.light[k] /= all.area_mm2;
      all.normal[k] /= all.area_mm2;
    }
    result.push_back(all);
  }
  return result;
}

/// Makes the box of a cell large enough for a sample.
void include(const params::HiddenSample& sample, params::HiddenCell& cell) {
  for (int k = 0; k < 3; ++k) {
    const float half = static_cast<float>(sample.parts) * (std::abs(sample.half_x[k]) + std::abs(sample.half_y[k]));
    cell.low[k] = std::min(cell.low[k], sample.position[k] - half);
    cell.high[k] = std::max(cell.high[k], sample.position[k] + half);
  }
}

/// Appends a cell, which has all its samples on each level.
void append_cell(std::span<const std::pair<Cube, const HiddenPatch*>> patches, const params::HiddenMaterial& material,
                 HiddenSamples& to) {
  const auto reach_mm = static_cast<double>(material.reach_mm);
  const double cell_mm = cell_side * reach_mm;
  const auto& cubes = joining_of(material).cubes;
  params::HiddenCell cell{};
  std::fill_n(cell.low, 3, std::numeric_limits<float>::infinity());
  std::fill_n(cell.high, 3, -std::numeric_limits<float>::infinity());
  std::vector<Sample> samples;
  const auto begin = [&](int level, std::size_t count) {
    cell.first[level] = static_cast<int>(to.samples.size());
    cell.samples[level] = static_cast<int>(count);
  };
  begin(0, patches.size());
  for (const auto& [cube, patch] : patches) {
    to.samples.push_back(params_of(*patch, reach_mm));
    include(to.samples.back(), cell);
    split(*patch, cell_mm / cubes[0] / 2, samples);
  }
  for (int level = 1; level < HIDDEN_LEVELS; ++level) {
    samples = joined(samples, patches.front().first, cell_mm, cubes[level - 1]);
    begin(level, samples.size());
    for (const Sample& sample : samples) {
      to.samples.push_back(params_of(sample));
      include(to.samples.back(), cell);
    }
  }
  to.cells.push_back(cell);
}

/// Lets each level pass into the next one between half of a distance and the whole of it.
void set_levels(params::HiddenMaterial& material) {
  const auto reach_mm = static_cast<double>(material.reach_mm);
  const auto f = [](double value) { return static_cast<float>(value); };
  for (params::HiddenLevel& level : material.levels) level = {-1, f(reach_mm * reach_mm), f(reach_mm), 0, 1, 0, 1};
  for (int level = 0; level < HIDDEN_LEVELS - 1; ++level) {
    const double far_mm2 = std::pow(joining_of(material).from[level] * reach_mm, 2);
    const double near_mm2 = far_mm2 / 4;
    const double slope = 1 / (far_mm2 - near_mm2);
    params::HiddenLevel& finer = material.levels[level];
    params::HiddenLevel& next = material.levels[level + 1];
    finer.to_mm2 = f(far_mm2);
    finer.to_mm = f(std::sqrt(far_mm2));
    finer.fall_slope = f(-slope);
    finer.fall_offset = f(far_mm2 * slope);
    next.from_mm2 = f(near_mm2);
    next.rise_slope = f(slope);
    next.rise_offset = f(-near_mm2 * slope);
  }
}

/// Appends the cells of one material.
void append_cells(std::span<const HiddenPatch> patches, params::HiddenMaterial material, HiddenSamples& to) {
  const auto reach_mm = static_cast<double>(material.reach_mm);
  material.first_cell = static_cast<int>(to.cells.size());
  set_levels(material);
  const double cell_mm = cell_side * reach_mm;
  std::vector<std::pair<Cube, const HiddenPatch*>> sorted;
  for (const HiddenPatch& patch : patches) sorted.emplace_back(cube_of(patch.patch->at, cell_mm), &patch);
  std::sort(sorted.begin(), sorted.end());  // patches of a cube as they are in the list
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    while (last < sorted.size() && sorted[last].first == sorted[first].first) ++last;
    append_cell({sorted.data() + first, last - first}, material, to);
  }
  material.cells = static_cast<int>(to.cells.size()) - material.first_cell;
  to.materials.push_back(material);
}

}  // namespace

HiddenSamples hidden_samples(std::span<const ViewPixels> views, std::span<const params::HiddenMaterial> profiles) {
  std::vector<std::vector<Patch>> patches;
  for (const ViewPixels& view : views) patches.push_back(patches_of(view));
  std::vector<PatchGrid> grids;
  if (views.size() > 1) {
    for (const std::vector<Patch>& its : patches) grids.emplace_back(its);
  }
  std::vector<std::vector<HiddenPatch>> by_material(profiles.size());
  for (std::size_t v = 0; v < patches.size(); ++v) {
    for (const Patch& patch : patches[v]) {
      if (!patch.is_hidden) continue;
      double density = 1 / patch.area_mm2;
      for (std::size_t other = 0; other < grids.size(); ++other) {
        if (other != v) density += grids[other].density_at(patch);
      }
      by_material[patch.material].push_back({&patch, 1 / density});
    }
  }
  HiddenSamples result;
  for (std::size_t m = 0; m < profiles.size(); ++m) append_cells(by_material[m], profiles[m], result);
  return result;
}

}  // namespace dermis
