// Mattes: pixels that a material covers in part.
#include <algorithm>
#include <cmath>
#include <vector>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/materials.hpp"
#include "dermis/oracle/scenes.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/compare_light.hpp"
#include "support/random_frame.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;

namespace {

/// An antialiased disc of skin under light 1 before something bright that does not scatter.
struct Disc {
  static constexpr int width = 96;
  static constexpr int height = 80;
  static constexpr double bright = 10;
  std::vector<float> light, depth, ids, matte, scattered;

  Disc() : scattered(3 * width * height) {
    constexpr int samples = 8;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        int inside = 0;
        for (int i = 0; i < samples * samples; ++i) {
          const double px = x + (i % samples + 0.5) / samples;
          const double py = y + (i / samples + 0.5) / samples;
          inside += std::hypot(px - 47.3, py - 39.6) < 27.4 ? 1 : 0;
        }
        const double share = static_cast<double>(inside) / (samples * samples);
        matte.push_back(static_cast<float>(share));
        ids.push_back(share >= 0.5 ? 1 : 0);
        depth.push_back(100);
        for (int c = 0; c < 3; ++c) light.push_back(static_cast<float>(share + bright * (1 - share)));
      }
    }
  }

  std::vector<float> filter(bool with_matte, Method method) {
    Frame frame{.width = width, .height = height, .camera = Camera::orthographic(4, 4)};
    frame.light.host = light.data();
    frame.depth.host = depth.data();
    if (with_matte)
      frame.matte.host = matte.data();
    else
      frame.material.host = ids.data();
    frame.scattered.host = scattered.data();
    const Options options{.method = method, .taps = {.rank = 2, .count = 17}};
    Plan(Device::open(), {{1, dermis::preset("skin").profile}}, FrameDescription::of(frame), options).run(frame);
    return scattered;
  }

  /// Returns how much light from behind the disc reaches pixels that it covers wholly: their largest distance from 1.
  double leak(const std::vector<float>& image) const {
    double most = 0;
    for (std::size_t i = 0; i < image.size(); ++i)
      if (matte[i / 3] == 1) most = std::max(most, std::abs(static_cast<double>(image[i]) - 1));
    return most;
  }
};

}  // namespace

TEST_CASE("edges that a matte covers in part blend, and leak less than those that an id takes or leaves", "[matte]") {
  for (const Method method : {Method::separable, Method::exact}) {
    Disc disc;
    const std::vector<float> by_matte = disc.filter(true, method);
    const std::vector<float> by_id = disc.filter(false, method);
    INFO("leaks " << disc.leak(by_matte) << ", " << disc.leak(by_id));
    CHECK(disc.leak(by_id) > 0.1);
    CHECK(disc.leak(by_matte) < 0.5 * disc.leak(by_id));
    double dimmed = 0;
    for (std::size_t i = 0; i < by_matte.size(); ++i) {
      const double share = disc.matte[i / 3];
      const double before = disc.light[i];
      const double after = by_matte[i];
      if (share == 0) CHECK(after == before);
      if (share == 0 || share == 1) continue;
      CHECK(after >= 1 - 1e-5);  // The pixel is never darker than the disc.
      // No more than the share that the disc covers loses light.
      CHECK(before - after <= share * (before - 1) + 1e-5);
      dimmed = std::max(dimmed, before - after);
    }
    CHECK(dimmed > 1);
  }
}

TEST_CASE("the exact method equals the surface integral where materials cover pixels in part", "[matte][exact]") {
  const dermis::oracle::Scene scene = dermis::oracle::scene("sphere", 45, 31, 3);
  Random random(91);
  std::vector<float> matte;
  for (std::size_t i = 0; i < scene.depth.size(); ++i)
    matte.push_back(random.integer(0, 3) == 0 ? static_cast<float>(random.uniform(0, 1)) : 1);
  std::vector<float> scattered(scene.light.size());
  Frame frame = scene.frame();
  frame.scattered.host = scattered.data();
  const std::vector<dermis::Material> materials = {{1, dermis::preset("skin").profile}};
  const Options options{.method = Method::exact};
  const auto filtered = [&] {
    Plan(Device::open(), materials, FrameDescription::of(frame), options).run(frame);
    return picture_of(scene.width, scene.height, scattered);
  };
  const dermis::oracle::Picture without = filtered();
  frame.matte.host = matte.data();
  const auto expected =
      dermis::oracle::surface_integral(frame, dermis::oracle::materials_of(materials, options.taps), options).scattered;
  // As without a matte, the error is that of the profile's tables.
  CHECK(dermis::oracle::compare(filtered(), expected).relative_l2 <= 1e-5);
  CHECK(dermis::oracle::compare(without, expected).relative_l2 > 1e-2);
}

TEST_CASE("a matte that covers all gives the bits of none, one that covers nothing those of another id", "[matte]") {
  Random random(90);
  RandomFrame made(random, {.width = 67, .height = 45, .materials = 2, .jitter = 0.0});
  for (dermis::Material& material : made.materials) {
    material.profile = dermis::Profile::burley({3, 2, 1});
    material.taps = {.rank = 2, .count = 11};  // a random design may have next to no light beyond the pixel
  }
  made.matte.emplace(67, 45, 1, dermis::Format::f16, &random);
  GuardedImage ids(67, 45, 1, dermis::Format::f32, nullptr);
  for (int y = 0; y < 45; ++y) {
    for (int x = 0; x < 67; ++x) {
      const bool is_left = x < 30;
      made.matte->set(x, y, 0, is_left ? 1 : 0);
      ids.set(x, y, 0, is_left ? made.material->get(x, y, 0) : 9);
    }
  }
  const auto scattered = [&](const Frame& frame) {
    Plan(Device::open(), made.materials, FrameDescription::of(frame), made.options).run(frame);
    std::vector<double> values;
    for (int y = 0; y < 45; ++y)
      for (int x = 0; x < 67; ++x)
        for (int c = 0; c < 3; ++c) values.push_back(made.scattered->get(x, y, c));
    return values;
  };
  Frame with_ids = made.frame();
  with_ids.matte = {};
  with_ids.material = ids.image();
  const std::vector<double> by_ids = scattered(with_ids);
  const std::vector<double> by_matte = scattered(made.frame());
  CHECK(by_matte == by_ids);
  double change = 0;
  for (std::size_t i = 0; i < by_ids.size(); ++i)
    change =
        std::max(change, std::abs(by_ids[i] - made.light->get(static_cast<int>(i / 3 % 67),
                                                              static_cast<int>(i / 3 / 67), static_cast<int>(i % 3))));
  CHECK(change > 0.01);
}
