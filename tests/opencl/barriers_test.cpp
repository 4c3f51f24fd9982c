// Kernels whose work-items wait for each other, on frames that do not fill their work-groups: the bits of those that do
// not. `./check --long` runs this under Oclgrind, which finds races.
#include <algorithm>
#include <cstring>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

using dermis::Device;
using dermis::FrameDescription;
using dermis::Plan;

namespace {

constexpr int sizes[][2] = {{1, 1}, {7, 5}, {37, 19}};

std::vector<float> scattered_on(const Device& device, RandomFrame& frame, int width, int height) {
  const auto description = FrameDescription::of(frame.frame());
  Plan(device, frame.materials, description, frame.options).run(frame.frame());
  std::vector<float> values;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(frame.scattered->get(x, y, c)));
    }
  }
  return values;
}

}  // namespace

TEST_CASE("classification by work-groups gives the bits of that by vectors", "[barriers]") {
  const Device device = Device::open();
  unsigned salt = 7400;
  for (const auto& [width, height] : sizes) {
    Random random(salt++);
    RandomFrame frame(random, {.width = width, .height = height, .materials = 2, .jitter = 0});
    frame.options.method = dermis::Method::separable;
    frame.options.skip_uniform_light = false;  // only tiles know
    for (dermis::Material& material : frame.materials) material.taps = dermis::TapsDesign{.rank = 1, .count = 5};
    CAPTURE(test_seed(), width, height);
    const std::vector<float> by_vectors = scattered_on(with_kernel_shape(device, 16, "CPU"), frame, width, height);
    const std::vector<float> by_groups = scattered_on(with_kernel_shape(device, 1, "GPU"), frame, width, height);
    CHECK(std::memcmp(by_groups.data(), by_vectors.data(), by_groups.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("textures by work-groups have the bits of those by vectors", "[barriers]") {
  const Device device = Device::open();
  Random random(7410);
  for (const auto& [width, height] : sizes) {
    std::vector<float> light(3UL * width * height);
    std::vector<float> mask(std::size_t{1} * width * height);
    for (float& value : light) value = static_cast<float>(random.uniform(0, 2));
    for (float& value : mask) value = random.integer(0, 9) > 0 ? 1.0F : 0.0F;
    std::vector<std::vector<float>> results;
    for (const Device& its : {with_kernel_shape(device, 16, "CPU"), with_kernel_shape(device, 1, "GPU")}) {
      const dermis::TexturePlan plan(its, dermis::preset("skin").profile, {.mask = true});
      std::vector<float> scattered(light.size());
      const auto stats = plan.run({.width = width,
                                   .height = height,
                                   .light = {.host = light.data()},
                                   .mask = {.host = mask.data()},
                                   .mm_per_texel = 2,
                                   .scattered = {.host = scattered.data()}});
      CHECK(stats.texels_empty == std::count(mask.begin(), mask.end(), 0.0F));
      results.push_back(scattered);
    }
    CAPTURE(test_seed(), width, height);
    CHECK(std::memcmp(results[0].data(), results[1].data(), light.size() * sizeof(float)) == 0);
  }
}
