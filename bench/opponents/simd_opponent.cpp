// The plain rank 1 filter with constant whole offsets, in C++ with vectors: both passes of a strip stay in cache, and
// all cores share the strips. It shows the speed of the processor. Each material is filtered by itself, with the taps
// for the median depth of its pixels, where it has pixels; to it all others are background.
#include <algorithm>
#include <atomic>
#include <bit>

#include "opponents/opponents.hpp"
#include "opponents/simd_strip.hpp"
#include "support/parallel.hpp"

namespace dermis::bench {

namespace {

using StripFilter = void (*)(const Strip&, bool);

StripFilter best_filter() {
#if defined(DERMIS_BENCH_X86)
  if (__builtin_cpu_supports("avx512f") != 0) return filter_strip_avx512;
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0) return filter_strip_avx2;
#endif
  return filter_strip_plain;
}

/// The rows first..end - 1 of a strip.
struct Rows {
  int first = 0, end = 0;
};

/// A material: its taps, and where its pixels are.
struct Layer {
  std::vector<int> offsets_px;  ///< one for both axes: pixels count as square
  std::vector<float> weights;
  Strip strip = {};             ///< of the whole frame
  std::vector<Rows> rows = {};  ///< of each strip, those that hold all of its pixels
};

Layer layer_of(const Scene& scene, std::size_t material, int count) {
  const Profile& profile = scene.materials[material].profile;
  const TapSet set = make_tap_set(profile, {.rank = 1, .count = count}, scene.median_pixel_mm(material));
  const std::vector<std::array<float, 3>>& weights = set.terms.front().weights;
  const std::size_t middle = weights.size() / 2;
  Layer layer;
  std::copy_n(weights[middle].begin(), 3, layer.strip.centre_weight);
  for (std::size_t i = middle + 1; i < weights.size(); ++i) {
    layer.offsets_px.push_back(static_cast<int>(set.offsets_px[i]));
    layer.weights.insert(layer.weights.end(), weights[i].begin(), weights[i].end());
  }
  const double radius = depth_radius_mm(profile) / scene.mm_per_unit;
  layer.strip.falloff = static_cast<float>(1 / (radius * radius));
  return layer;
}

class Vectorised final : public Opponent {
 public:
  Vectorised(const Case& what, const Scene& scene)
      : scene_(scene), with_depth_(what.family == Family::simd_depth), filter_(best_filter()) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m) layers_.push_back(layer_of(scene, m, what.design.count));
    place_planes();
    for (std::size_t m = 0; m < layers_.size(); ++m) place_layer(m);
  }

  void run() override {
    std::atomic<int> next = 0;
    on_all_cores([&](std::size_t worker, std::size_t) {
      for (int i = next++; i < strips(); i = next++) {
        for (const Layer& layer : layers_) filter(layer, i, rings_[worker].data());
      }
    });
  }

  std::vector<float> result() override {
    std::vector<float> planes;
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < scene_.spec.height; ++y) {
        const float* row = start_of(scattered_plane + c) + y * pitch_;
        planes.insert(planes.end(), row, row + scene_.spec.width);
      }
    }
    return planes;
  }

 private:
  // The planes in memory: three of light, three to write, then the depth of each layer.
  static constexpr int scattered_plane = 3;
  static constexpr int depth_plane = 6;

  int strips() const { return (scene_.spec.width + strip_width_px - 1) / strip_width_px; }

  /// The first pixel of a plane.
  float* start_of(std::size_t plane) { return memory_.data() + plane * pitch_ * scene_.spec.height + margin_; }

  /// One strip of a layer, as if its rows were all there is: beyond them it has no pixels.
  void filter(const Layer& layer, int number, float* ring) const {
    const Rows& rows = layer.rows[number];
    if (rows.first == rows.end) return;
    Strip strip = layer.strip;
    for (int c = 0; c < 3; ++c) {
      strip.light[c] += rows.first * pitch_;
      strip.scattered[c] += rows.first * pitch_;
    }
    strip.depth += rows.first * pitch_;
    strip.height = rows.end - rows.first;
    strip.first_column = number * strip_width_px;
    strip.ring = ring;
    filter_(strip, with_depth_);
  }

  /// Fills all planes. Each row has room at both ends, where depth is that of the background and light is black.
  /// Outputs begin as the light, which pixels without a material keep.
  void place_planes() {
    const int width = scene_.spec.width;
    int reach = 0;
    for (const Layer& layer : layers_) {
      for (const int offset : layer.offsets_px) reach = std::max(reach, offset);
    }
    margin_ = (reach + 15) / 16 * 16;
    pitch_ = margin_ + strips() * strip_width_px + margin_;
    const std::size_t plane = static_cast<std::size_t>(pitch_) * scene_.spec.height;
    memory_.assign(depth_plane * plane, 0.0F);
    memory_.resize((depth_plane + layers_.size()) * plane, 1e10F);
    for (std::size_t pixel = 0; pixel < scene_.pixels(); ++pixel) {
      const std::size_t place = pixel / width * pitch_ + pixel % width;
      for (int c = 0; c < 3; ++c) {
        start_of(c)[place] = start_of(scattered_plane + c)[place] = scene_.light[scene_.at(pixel, c)];
      }
      if (const std::optional<std::size_t> material = scene_.material_of(pixel)) {
        start_of(depth_plane + *material)[place] = scene_.depth[pixel];
      }
    }
    ring_rows_ = static_cast<int>(std::bit_ceil(2U * reach + 1));
    rings_.assign(core_count(), std::vector<float>(3UL * ring_rows_ * strip_width_px));
  }

  void place_layer(std::size_t material) {
    Layer& layer = layers_[material];
    Strip& strip = layer.strip;
    for (int c = 0; c < 3; ++c) {
      strip.light[c] = start_of(c);
      strip.scattered[c] = start_of(scattered_plane + c);
    }
    strip.depth = start_of(depth_plane + material);
    strip.pitch = pitch_;
    strip.offsets_px = layer.offsets_px.data();
    strip.weights = layer.weights.data();
    strip.pairs = static_cast<int>(layer.offsets_px.size());
    strip.ring_rows = ring_rows_;
    layer.rows.resize(strips());
    for (std::size_t pixel = 0; pixel < scene_.pixels(); ++pixel) {
      if (scene_.material_of(pixel) != material) continue;
      const int y = static_cast<int>(pixel) / scene_.spec.width;
      Rows& its = layer.rows[static_cast<int>(pixel) % scene_.spec.width / strip_width_px];
      if (its.end == 0) its.first = y;
      its.end = y + 1;
    }
  }

  const Scene& scene_;
  bool with_depth_;
  StripFilter filter_;
  std::vector<Layer> layers_;
  std::ptrdiff_t margin_ = 0;  ///< floats before the first pixel of a row
  std::ptrdiff_t pitch_ = 0;   ///< floats from row to row
  int ring_rows_ = 0;
  std::vector<float> memory_;
  std::vector<std::vector<float>> rings_;
};

}  // namespace

std::unique_ptr<Opponent> make_simd(const Case& what, const Scene& scene) {
  return std::make_unique<Vectorised>(what, scene);
}

}  // namespace dermis::bench
