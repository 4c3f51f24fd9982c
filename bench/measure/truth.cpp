#include "measure/truth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "dermis/error.hpp"

namespace dermis::bench {

namespace {

/// A block is as wide as the vectors that the kernels work on, and is aligned like them.
constexpr int block_width_px = 16;
constexpr int block_height_px = 4;

/// The number of blocks whose surface integral is affordable.
int affordable_blocks(const Scene& scene) {
  constexpr double pairs = 2.5e8;  // a few seconds of two cores
  const double typical_reach_px =
      kernel_reach * scene.spec.kernel_px / 2;  // most of the scene is at depth 2 and beyond
  return std::max(8,
                  static_cast<int>(pairs / std::pow(2 * typical_reach_px + 1, 2) / (block_width_px * block_height_px)));
}

/// The covered pixels of blocks at random places, one in every block of a grid over the covered ellipse.
std::vector<std::size_t> sampled_pixels(const Scene& scene) {
  const int width = scene.spec.width;
  const int height = scene.spec.height;
  const double half = std::min(0.5, std::sqrt(scene.spec.coverage_percent / (100 * std::numbers::pi)));
  const double left = (0.5 - half) * width;
  const double top = (0.5 - half) * height;
  const int blocks = std::max(1, static_cast<int>(std::sqrt(affordable_blocks(scene))));
  std::mt19937 random(1);
  std::set<std::size_t> pixels;
  for (int i = 0; i < blocks * blocks; ++i) {
    const auto place = [&](int block) { return (block + static_cast<double>(random()) * 0x1p-32) / blocks * 2 * half; };
    const int first_x = static_cast<int>(left + place(i % blocks) * width) / block_width_px * block_width_px;
    const int first_y = static_cast<int>(top + place(i / blocks) * height) / block_height_px * block_height_px;
    for (int y = first_y; y < std::min(first_y + block_height_px, height); ++y) {
      for (int x = first_x; x < std::min(first_x + block_width_px, width); ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
        if (!scene.is_background(pixel)) pixels.insert(pixel);
      }
    }
  }
  return {pixels.begin(), pixels.end()};
}

/// Sums over values of a result and the truth.
struct Sums {
  double error = 0, power = 0, total = 0, largest = 0;

  void add(const std::vector<float>& result, const Truth& truth, std::size_t place) {
    const std::size_t plane = result.size() / 3;
    for (std::size_t c = 0; c < 3; ++c) {
      const double wanted = truth.light[3 * place + c];
      const auto seen = static_cast<double>(result[c * plane + truth.pixels[place]]);
      // Both keep light that is not finite.
      if (!std::isfinite(wanted) && !std::isfinite(seen)) continue;
      const double difference = seen - wanted;
      error += difference * difference;
      power += wanted * wanted;
      total += wanted;
      // A comparison with something that is not a number is false.
      if (!(std::abs(difference) <= largest)) largest = std::abs(difference);
    }
  }

  double rel_l2() const { return error == 0 ? 0 : std::sqrt(error / power); }
};

}  // namespace

Truth TruthMaker::surface_integral(const Scene& scene) {
  Truth truth = {.source = {}, .pixels = sampled_pixels(scene)};
  truth.source = fmt::format("surface integral at {} of its pixels, all over it", truth.pixels.size());
  // Elsewhere the kernel is so narrow that pixels give light but take none, and cost nothing.
  std::vector<float> mask(scene.pixels(), 1e-6F);
  for (const std::size_t pixel : truth.pixels) mask[pixel] = 1;
  std::vector<float> scattered(scene.light.size());
  Frame frame = scene.frame(scattered.data());
  frame.mask.host = mask.data();
  if (!exact_) {
    exact_.emplace(device_, scene.materials, FrameDescription::of(frame), Options{.method = Method::exact});
  }
  exact_->run(frame);
  for (const std::size_t pixel : truth.pixels) {
    for (std::size_t c = 0; c < 3; ++c) truth.light.push_back(static_cast<double>(scattered[scene.at(pixel, c)]));
  }
  return truth;
}

Truth TruthMaker::truth_of(const Scene& scene) {
  if (scene.covered == 0) throw Error(ErrorCode::usage, "scene", scene.spec.name(), "pixels that scatter");
  const bool is_whole_plane = scene.spec.geometry == Geometry::flat && scene.spec.coverage_percent == 100;
  return is_whole_plane ? exact_convolution(scene) : surface_integral(scene);
}

Distance distance(const std::vector<float>& result, const Truth& truth) {
  Sums all;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) all.add(result, truth, i);
  Distance found = {all.rel_l2(), all.largest * static_cast<double>(truth.light.size()) / all.total, {}};
  for (const Part& part : truth.parts) {
    Sums sums;
    for (const std::size_t place : part.places) sums.add(result, truth, place);
    found.rel_l2_of_parts.push_back(sums.rel_l2());
  }
  return found;
}

}  // namespace dermis::bench
