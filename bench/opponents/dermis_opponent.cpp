// dermis itself, as its callers see it: plan.run on images in host memory.
#include <algorithm>
#include <cstdint>

#include "measure/aligned.hpp"
#include "opponents/opponents.hpp"
#include "support/half.hpp"

namespace dermis::bench {

namespace {

class Filter final : public Opponent {
 public:
  Filter(const Case& what, const Scene& scene, const Device& device)
      : scene_(scene),
        half_(what.memory == Memory::interleaved_f16),
        in_place_(what.scene.coverage_percent < 100),
        plan_(device, {{.profile = skin()}}, {.depth = true}, options_of(what)) {
    const std::size_t plane = scene.pixels();
    if (half_) {
      // Red, green, blue and an alpha that nobody reads.
      half_light_.resize(4 * plane);
      half_scattered_.resize(4 * plane);
      for (std::size_t i = 0; i < plane; ++i) {
        for (std::size_t c = 0; c < 3; ++c) half_light_[4 * i + c] = half_of(scene.light[c * plane + i]);
      }
    } else if (in_place_) {
      scattered_.assign(scene.light.begin(), scene.light.end());
    } else {
      scattered_.resize(3 * plane);
    }
  }

  void reset() override {
    if (in_place_) std::copy(scene_.light.begin(), scene_.light.end(), scattered_.begin());
  }

  void run() override { stats_ = plan_.run(frame()); }

  std::vector<float> result() override {
    if (!half_) return {scattered_.begin(), scattered_.end()};
    const std::size_t plane = scene_.pixels();
    std::vector<float> planes(3 * plane);
    for (std::size_t i = 0; i < plane; ++i) {
      for (std::size_t c = 0; c < 3; ++c) planes[c * plane + i] = float_of(half_scattered_[4 * i + c]);
    }
    return planes;
  }

  std::optional<Stats> stats() override { return stats_; }

 private:
  static Options options_of(const Case& what) {
    return {.method = what.family == Family::dermis_exact  ? Method::exact
                      : what.family == Family::dermis_disc ? Method::disc
                                                           : Method::separable,
            .taps = what.design,
            .disc = what.disc,
            .sheared = what.sheared};
  }

  Frame frame() {
    const auto plane_bytes = static_cast<std::ptrdiff_t>(scene_.pixels() * sizeof(float));
    const Layout planar = {
        .format = Format::f32, .channel_stride = plane_bytes, .pixel_stride = 4, .row_stride = 4L * scene_.spec.width};
    const Layout interleaved = {
        .format = Format::f16, .channel_stride = 2, .pixel_stride = 8, .row_stride = 8L * scene_.spec.width};
    Frame frame = {.width = scene_.spec.width,
                   .height = scene_.spec.height,
                   .depth = {.host = scene_.depth.data()},
                   .camera = scene_.camera,
                   .mm_per_unit = scene_.mm_per_unit};
    if (half_) {
      frame.light = {.host = half_light_.data(), .layout = interleaved};
      frame.scattered = {.host = half_scattered_.data(), .layout = interleaved};
    } else {
      frame.light = {.host = in_place_ ? scattered_.data() : scene_.light.data(), .layout = planar};
      frame.scattered = {.host = scattered_.data(), .layout = planar};
    }
    return frame;
  }

  const Scene& scene_;
  bool half_, in_place_;
  Plan plan_;
  AlignedFloats scattered_;
  std::vector<std::uint16_t> half_light_, half_scattered_;
  Stats stats_;
};

}  // namespace

std::unique_ptr<Opponent> make_dermis(const Case& what, const Scene& scene, const Device& device) {
  return std::make_unique<Filter>(what, scene, device);
}

}  // namespace dermis::bench
