// Kernels whose work-items wait for each other, on frames that do not fill their work-groups: the bits of those that do
// not. `./check --long` runs this under Oclgrind, which finds races.
#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

using dermis::Device;
using dermis::FrameDescription;
using dermis::Plan;

namespace {

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

/// Frames of these sizes, of the same images and settings, so that the kernels are built once.
void check_work_groups(unsigned salt, const std::vector<std::pair<int, int>>& its_sizes,
                       const dermis::TapsDesign& design) {
  const Device device = Device::open();
  std::optional<RandomFrame> first;
  for (const auto& [width, height] : its_sizes) {
    std::optional<RandomFrame> frame;
    do {
      Random random(salt++);
      frame.emplace(random, RandomFrameChoice{.width = width, .height = height, .materials = 2, .jitter = 0});
    } while (first && FrameDescription::of(frame->frame()) != FrameDescription::of(first->frame()));
    frame->options.method = dermis::Method::separable;
    frame->options.skip_uniform_light = false;  // only tiles know
    if (!first) first = frame;
    frame->options = first->options;
    frame->materials = first->materials;
    for (dermis::Material& material : frame->materials) material.taps = design;
    CAPTURE(test_seed(), width, height);
    const std::vector<float> by_vectors = scattered_on(with_kernel_shape(device, 16, "CPU"), *frame, width, height);
    const std::vector<float> by_groups = scattered_on(with_kernel_shape(device, 1, "GPU"), *frame, width, height);
    CHECK(std::memcmp(by_groups.data(), by_vectors.data(), by_groups.size() * sizeof(float)) == 0);
  }
}

}  // namespace

TEST_CASE("classification and passes by work-groups have the bits of those by vectors", "[barriers]") {
  check_work_groups(7400, {{1, 1}, {7, 5}, {257, 89}}, {.rank = 1, .count = 5});
}

// Under Oclgrind alone: the kernels take long to build.
TEST_CASE("so have passes whose taps do not fit in local memory", "[barriers][.]") {
  check_work_groups(7500, {{73, 37}}, {.model = dermis::Model::gaussians, .rank = 3, .count = 129});
}

TEST_CASE("textures by work-groups have the bits of those by vectors", "[barriers]") {
  const Device device = Device::open();
  Random random(7410);
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {37, 19}}) {
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
