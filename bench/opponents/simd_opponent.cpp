// The plain rank 1 filter with constant whole offsets, in C++ with vectors: both passes of a strip stay in cache, and
// all cores share the strips. It shows the speed of the processor.
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

class Vectorised final : public Opponent {
 public:
  Vectorised(const Case& what, const Scene& scene)
      : scene_(scene), with_depth_(what.family == Family::simd_depth), filter_(best_filter()) {
    const TapsDesign design = {.rank = 1, .count = what.design.count};
    const TapSet set = make_tap_set(skin(), design, 1 / scene.px_per_mm());
    const std::vector<std::array<float, 3>>& weights = set.terms.front().weights;
    const std::size_t middle = weights.size() / 2;
    std::copy_n(weights[middle].begin(), 3, strip_.centre_weight);
    for (std::size_t i = middle + 1; i < weights.size(); ++i) {
      offsets_px_.push_back(static_cast<int>(set.offsets_px[i]));
      weights_.insert(weights_.end(), weights[i].begin(), weights[i].end());
    }
    const double radius = 3.3 * skin_width_mm / scene.mm_per_unit;  // scene units, where weights reach 0
    strip_.falloff = static_cast<float>(1 / (radius * radius));
    place_planes();
  }

  void run() override {
    const int strips = (scene_.spec.width + strip_width_px - 1) / strip_width_px;
    std::atomic<int> next = 0;
    on_all_cores([&](std::size_t worker, std::size_t) {
      Strip strip = strip_;
      strip.ring = rings_[worker].data();
      for (int i = next++; i < strips; i = next++) {
        strip.first_column = i * strip_width_px;
        filter_(strip, with_depth_);
      }
    });
  }

  std::vector<float> result() override {
    std::vector<float> planes;
    for (const float* plane : strip_.scattered) {
      for (int y = 0; y < scene_.spec.height; ++y) {
        const float* row = plane + y * strip_.pitch;
        planes.insert(planes.end(), row, row + scene_.spec.width);
      }
    }
    return planes;
  }

 private:
  /// Three planes of light, one of depth and three to write, each row with room at both ends where depth is that of
  /// the background and light is black.
  void place_planes() {
    const int width = scene_.spec.width;
    const int height = scene_.spec.height;
    const int margin = (offsets_px_.back() + 15) / 16 * 16;
    strip_.pitch = margin + (width + strip_width_px - 1) / strip_width_px * strip_width_px + margin;
    strip_.height = height;
    const std::size_t plane = strip_.pitch * height;
    memory_.assign(7 * plane, 0.0F);
    std::fill_n(memory_.begin() + 3 * plane, plane, 1e10F);
    const auto start_of = [&](int index) { return memory_.data() + index * plane + margin; };
    for (int c = 0; c < 4; ++c) {
      const float* from = c < 3 ? scene_.light.data() + c * scene_.pixels() : scene_.depth.data();
      for (int y = 0; y < height; ++y) std::copy_n(from + y * width, width, start_of(c) + y * strip_.pitch);
    }
    for (int c = 0; c < 3; ++c) {
      strip_.light[c] = start_of(c);
      strip_.scattered[c] = start_of(4 + c);
    }
    strip_.depth = start_of(3);
    strip_.offsets_px = offsets_px_.data();
    strip_.weights = weights_.data();
    strip_.pairs = static_cast<int>(offsets_px_.size());
    strip_.ring_rows = static_cast<int>(std::bit_ceil(2U * offsets_px_.back() + 1));
    rings_.assign(core_count(), std::vector<float>(3UL * strip_.ring_rows * strip_width_px));
  }

  const Scene& scene_;
  bool with_depth_;
  StripFilter filter_;
  Strip strip_ = {};
  std::vector<int> offsets_px_;
  std::vector<float> weights_;
  std::vector<float> memory_;
  std::vector<std::vector<float>> rings_;
};

}  // namespace

std::unique_ptr<Opponent> make_simd(const Case& what, const Scene& scene) {
  return std::make_unique<Vectorised>(what, scene);
}

}  // namespace dermis::bench
