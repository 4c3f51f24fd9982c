#include "views/hidden_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace dermis {

namespace {

/// The sides of joined samples, and the distances from which on they count instead of finer ones, as shares of the
/// reach; from half of such a distance on they count in part.
constexpr std::array<double, HIDDEN_LEVELS - 1> joined_side = {1.0 / 20, 1.0 / 10};
constexpr std::array<double, HIDDEN_LEVELS - 1> joined_from = {4.0 / 20, 6.0 / 10};
/// A projected profile is much steeper where it looks along a plane: 2 % off with half the side, 5 % with the whole.
constexpr double projected_side = 0.5;
constexpr double cell_side = 4.0 / 20;

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
    if (pixel.material == 0) continue;
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

/// A sample before it is sorted into cells.
struct Sample {
  Vector at, normal, light;
  double area_mm2;
};

void split(const Patch& patch, double area_mm2, double reach_mm, std::vector<Sample>& samples) {
  const double side = std::sqrt(patch.area_mm2);
  const int parts = std::clamp(static_cast<int>(std::ceil(side / (largest_part * reach_mm))), 1, most_parts);
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      const auto offset = [&](int k) { return (k + 0.5) / parts - 0.5; };
      const Vector at = sum(sum(patch.at, patch.along_x, offset(i)), patch.along_y, offset(j));
      samples.push_back({at, patch.normal, patch.light, area_mm2 / (parts * parts)});
    }
  }
}

params::HiddenSample params_of(const Sample& sample) {
  const auto f = [](double value) { return static_cast<float>(value); };
  return {{f(sample.at[0]), f(sample.at[1]), f(sample.at[2])},
          f(sample.area_mm2),
          {f(sample.light[0]), f(sample.light[1]), f(sample.light[2])},
          {f(sample.normal[0]), f(sample.normal[1]), f(sample.normal[2])},
          {}};
}

/// The axis that a normal is nearest to, with its sign: samples of both sides of a thin part stay apart.
int side_of(const Vector& normal) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
  }
  return 2 * axis + (normal[axis] > 0 ? 1 : 0);
}

/// Joins the samples of each small cube and side to one, at their mean place with their mean light and normal.
std::vector<Sample> joined(std::span<const Sample> samples, double side_mm) {
  std::vector<std::pair<std::array<std::int32_t, 4>, const Sample*>> sorted;
  for (const Sample& sample : samples) {
    const Cube cube = cube_of(sample.at, side_mm);
    sorted.push_back({{cube[0], cube[1], cube[2], side_of(sample.normal)}, &sample});
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Sample> result;
  for (std::size_t i = 0; i < sorted.size();) {
    Sample all{};
    const auto key = sorted[i].first;
    for (; i < sorted.size() && sorted[i].first == key; ++i) {
      const Sample& one = *sorted[i].second;
      all.at = sum(all.at, one.at, one.area_mm2);
      all.light = sum(all.light, one.light, one.area_mm2);
      all.normal = sum(all.normal, one.normal, one.area_mm2);
      all.area_mm2 += one.area_mm2;
    }
    for (int k = 0; k < 3; ++k) {
      all.at[k] /= all.area_mm2;
      all.light[k] /= all.area_mm2;
    }
    const double normal = length(all.normal);
    for (double& part : all.normal) part /= normal;
    result.push_back(all);
  }
  return result;
}

/// Appends the cells of one material.
void append_cells(std::vector<Sample>& samples, params::HiddenMaterial material, HiddenSamples& to) {
  const auto reach_mm = static_cast<double>(material.reach_mm);
  material.first_cell = static_cast<int>(to.cells.size());
  for (std::size_t level = 0; level < joined_from.size(); ++level) {
    material.near_mm[level] = static_cast<float>(joined_from[level] / 2 * reach_mm);
    material.far_mm[level] = static_cast<float>(joined_from[level] * reach_mm);
  }
  const double larger = material.crossing == CROSSING_PROJECTED ? projected_side : 1;
  const double side_mm = cell_side * reach_mm;
  std::stable_sort(samples.begin(), samples.end(),
                   [&](const Sample& a, const Sample& b) { return cube_of(a.at, side_mm) < cube_of(b.at, side_mm); });
  for (std::size_t first = 0; first < samples.size();) {
    std::size_t last = first;
    while (last < samples.size() && cube_of(samples[last].at, side_mm) == cube_of(samples[first].at, side_mm)) ++last;
    const std::span<const Sample> its(samples.data() + first, last - first);
    params::HiddenCell cell{};
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax_element(its.begin(), its.end(), [&](const auto& a, const auto& b) { return a.at[k] < b.at[k]; });
      cell.low[k] = static_cast<float>(low->at[k]);
      cell.high[k] = static_cast<float>(high->at[k]);
    }
    const auto append = [&to](std::span<const Sample> some, int& begin, int& count) {
      begin = static_cast<int>(to.samples.size());
      count = static_cast<int>(some.size());
      for (const Sample& sample : some) to.samples.push_back(params_of(sample));
    };
    append(its, cell.first[0], cell.samples[0]);
    for (std::size_t level = 0; level < joined_side.size(); ++level) {
      append(joined(its, joined_side[level] * larger * reach_mm), cell.first[level + 1], cell.samples[level + 1]);
    }
    to.cells.push_back(cell);
    first = last;
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
  std::vector<std::vector<Sample>> by_material(profiles.size());
  for (std::size_t v = 0; v < patches.size(); ++v) {
    for (const Patch& patch : patches[v]) {
      if (!patch.is_hidden) continue;
      double density = 1 / patch.area_mm2;
      for (std::size_t other = 0; other < grids.size(); ++other) {
        if (other != v) density += grids[other].density_at(patch);
      }
      split(patch, 1 / density, static_cast<double>(profiles[patch.material].reach_mm), by_material[patch.material]);
    }
  }
  HiddenSamples result;
  for (std::size_t m = 0; m < profiles.size(); ++m) append_cells(by_material[m], profiles[m], result);
  return result;
}

}  // namespace dermis
