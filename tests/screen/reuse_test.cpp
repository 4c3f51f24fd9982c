// Tiles of which nothing within reach has changed since the frame before.
#include <cmath>
#include <cstddef>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Plan;
using dermis::Reuse;
using dermis::Stats;
using dermis::TileKind;

namespace {

constexpr int width = 333;
constexpr int height = 217;
const dermis::Options small_tiles = {.taps = {.rank = 2, .count = 11}, .tile_width = 32, .tile_height = 32};

/// Two surfaces, one behind the other, under random light.
struct Shot {
  Camera camera = Camera::perspective(300, 300, width / 2.0, height / 2.0);
  std::vector<float> light, depth, material;
  std::vector<float> scattered;

  explicit Shot(Random& random) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        for (int c = 0; c < 3; ++c) light.push_back(static_cast<float>(random.uniform(0, 1)));
        depth.push_back(x + y < 250 ? 60.0F : 90.0F + 0.02F * static_cast<float>(x));
        material.push_back(y < 190 ? 1.0F : 0.0F);
      }
    }
    scattered.assign(light.size(), 0);
  }

  Frame frame() {
    Frame frame{.width = width,
                .height = height,
                .light = {.host = light.data()},
                .depth = {.host = depth.data()},
                .material = {.host = material.data()},
                .camera = camera};
    frame.scattered.host = scattered.data();
    return frame;
  }

  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x); }
};

Plan plan_of(const Device& device, Shot& shot, const dermis::Options& options = small_tiles) {
  return {device, {{1, dermis::preset("skin").profile}}, FrameDescription::of(shot.frame()), options};
}

/// The bits without reuse.
std::vector<float> alone(const Plan& plan, Shot shot) {
  plan.run(shot.frame());
  return shot.scattered;
}

}  // namespace

TEST_CASE("a frame that follows another has the same bits as by itself", "[reuse][tiles]") {
  const Device device = Device::open();
  Random random(900);
  Shot shot(random);
  const Plan plan = plan_of(device, shot);
  Reuse reuse;
  const Stats first = plan.run(shot.frame(), reuse);
  CHECK(first.count(TileKind::reused) == 0);
  CHECK(shot.scattered == alone(plan, shot));
  CHECK(shot.scattered != shot.light);
  const auto tiles = static_cast<std::int64_t>(first.tiles.kinds.size());
  const std::int64_t empty = first.count(TileKind::without_material);

  SECTION("nothing has changed") {
    shot.scattered.assign(shot.light.size(), -1);
    const Stats stats = plan.run(shot.frame(), reuse);
    CHECK(stats.count(TileKind::reused) == tiles - empty);
    CHECK(shot.scattered == alone(plan, shot));
  }
  SECTION("one value of one image is another") {
    for (int round = 0; round < 12; ++round) {
      const int x = random.integer(0, width - 1);
      const int y = random.integer(0, height - 1);
      CAPTURE(test_seed(), round, x, y);
      switch (round % 3) {
        case 0:
          shot.light[3 * Shot::at(x, y) + 1] += 0.5F;
          break;
        case 1:
          shot.depth[Shot::at(x, y)] += 5;
          break;
        default:
          shot.material[Shot::at(x, y)] = shot.material[Shot::at(x, y)] == 0 ? 1.0F : 0.0F;
      }
      const Stats stats = plan.run(shot.frame(), reuse);
      CHECK(shot.scattered == alone(plan, shot));
      CHECK(stats.count(TileKind::reused) > tiles / 4);
      CHECK(stats.count(TileKind::reused) + stats.count(TileKind::without_material) < tiles);
    }
  }
  SECTION("the camera is another") {
    shot.camera.scale_x = 310;
    CHECK(plan.run(shot.frame(), reuse).count(TileKind::reused) == 0);
    CHECK(shot.scattered == alone(plan, shot));
  }
  SECTION("the plan is another") {
    dermis::Options options = small_tiles;
    options.taps.count = 7;
    const Plan other = plan_of(device, shot, options);
    CHECK(other.run(shot.frame(), reuse).count(TileKind::reused) == 0);
    CHECK(shot.scattered == alone(other, shot));
    CHECK(plan.run(shot.frame(), reuse).count(TileKind::reused) == 0);
  }
}

TEST_CASE("a run that fails leaves nothing to the next one", "[reuse]") {
  const Device device = Device::open();
  Random random(901);
  Shot shot(random);
  dermis::Options options = small_tiles;
  options.bad_pixels = dermis::BadPixels::error;
  const Plan plan = plan_of(device, shot, options);
  Reuse reuse;
  plan.run(shot.frame(), reuse);
  const float good = shot.light[0];
  shot.light[0] = NAN;
  CHECK_THROWS_AS(plan.run(shot.frame(), reuse), dermis::Error);
  shot.light[0] = good;
  CHECK(plan.run(shot.frame(), reuse).count(TileKind::reused) == 0);
  CHECK(shot.scattered == alone(plan, shot));
}
