// dermis itself, as its callers see it: plan.run on images in host memory.
#include <algorithm>
#include <cstdint>

#include "inputs/half.hpp"
#include "measure/aligned_floats.hpp"
#include "opponents/opponents.hpp"

namespace dermis::bench {

namespace {

class Filter final : public Opponent {
 public:
  Filter(const Case& what, const Scene& scene, const Device& device)
      : scene_(scene),
        half_(what.memory == Memory::interleaved_f16),
        in_place_(what.scene.coverage_percent < 100),
        plan_(device, scene.materials, FrameDescription::of(scene.frame(nullptr)), options_of(what)) {
    scattered_.resize(half_ ? 0 : scene.light.size());
    if (in_place_) std::copy(scene.light.begin(), scene.light.end(), scattered_.begin());
    if (!half_) return;
    // A pixel is red, green, blue and an alpha that nobody reads.
    half_light_.resize(4 * scene.pixels());
    half_scattered_.resize(half_light_.size());
    each_value([&](std::size_t pixel, std::size_t c) {
      half_light_[4 * pixel + c] = half_of(static_cast<double>(scene.light[scene.at(pixel, c)]));
    });
  }

  void reset() override {
    if (in_place_) std::copy(scene_.light.begin(), scene_.light.end(), scattered_.begin());
  }

  void run() override { stats_ = plan_.run(frame()); }

  std::vector<float> result() override {
    std::vector<float> planes(3 * scene_.pixels());
    each_value([&](std::size_t pixel, std::size_t c) {
      planes[c * scene_.pixels() + pixel] =
          half_ ? static_cast<float>(value_of_half(half_scattered_[4 * pixel + c])) : scattered_[scene_.at(pixel, c)];
    });
    return planes;
  }

  std::optional<Stats> stats() override { return stats_; }

  std::size_t scratch_bytes() override { return plan_.scratch_bytes(scene_.spec.width, scene_.spec.height); }

 private:
  static Options options_of(const Case& what) {
    return {.method = what.family == Family::dermis_exact  ? Method::exact
                      : what.family == Family::dermis_disc ? Method::disc
                                                           : Method::separable,
            .taps = what.design,
            .disc = what.disc,
            .sheared = what.sheared,
            .jitter = what.jitter};
  }

  template <class Work>
  void each_value(const Work& work) const {
    for (std::size_t pixel = 0; pixel < scene_.pixels(); ++pixel) {
      for (std::size_t c = 0; c < 3; ++c) work(pixel, c);
    }
  }

  Frame frame() {
    Frame frame = scene_.frame(scattered_.data());
    if (in_place_) frame.light.host = scattered_.data();
    if (half_) {
      const Layout interleaved = {
          .format = Format::f16, .channel_stride = 2, .pixel_stride = 8, .row_stride = 8L * scene_.spec.width};
      frame.light = {.host = half_light_.data(), .layout = interleaved};
      frame.scattered = {.host = half_scattered_.data(), .layout = interleaved};
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
