// Pixels that are not scattered are counted, and keep their bits.
#include <cmath>
#include <cstring>

#include "dermis/plan.hpp"
#include "dermis/tap_tables.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Format;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Plan;
using dermis::Stats;
using dermis::TileKind;

TEST_CASE("pixels without material and narrow kernels keep their bits and are counted", "[skipping][tiles]") {
  const Device device = Device::open();
  constexpr int width = 200;
  constexpr int height = 70;
  GuardedImage light(width, height, 3, Format::f32), albedo(width, height, 3, Format::f32);
  GuardedImage beauty(width, height, 3, Format::f16), result(width, height, 3, Format::f16);
  GuardedImage scattered(width, height, 3, Format::f32), depth(width, height, 1, Format::f32);
  GuardedImage material(width, height, 1, Format::f32);
  Random random(800);
  // The left third has no material, the middle is so far away that the kernel is below half a pixel, the right
  // scatters.
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        light.set(x, y, c, random.uniform(0, 2));
        albedo.set(x, y, c, random.uniform(0, 1));
        beauty.set(x, y, c, random.uniform(0, 2));
      }
      depth.set(x, y, 0, x < 128 ? 1e6 : 100);
      material.set(x, y, 0, x < 64 ? 0 : 5);
    }
  }
  beauty.set(3, 3, 1, NAN);  // A pixel that is not touched may hold anything.
  light.set(150, 20, 0, NAN);
  light.set(160, 30, 2, INFINITY);

  Frame frame{.width = width, .height = height, .camera = Camera::perspective(400, 400, 100, 35)};
  frame.light = light.image();
  frame.albedo = albedo.image();
  frame.depth = depth.image();
  frame.material = material.image();
  frame.beauty = beauty.image();
  frame.scattered = scattered.output();
  frame.result = result.output();
  const Plan plan(device, {{5, dermis::preset("skin").profile}}, FrameDescription::of(frame),
                  {.tile_width = 64, .tile_height = 32});
  const Stats stats = plan.run(frame);

  CHECK(stats.pixels == width * height);
  CHECK(stats.pixels_without_material == 64 * height);
  CHECK(stats.pixels_narrow == 64 * height);
  CHECK(stats.pixels_bad == 2);
  CHECK(stats.pixels_scattered == (width - 128) * height);
  CHECK(stats.tiles.columns == 4);
  CHECK(stats.tiles.rows == 3);
  CHECK(stats.count(TileKind::without_material) == 3);
  CHECK(stats.count(TileKind::narrow) == 3);
  CHECK(stats.count(TileKind::flat) + stats.count(TileKind::curved) == 6);
  CHECK(stats.blocks.columns == 13);
  CHECK(stats.blocks.rows == 5);
  CHECK(stats.blocks.count(TileKind::without_material) == 4 * 5);
  CHECK(stats.blocks.count(TileKind::narrow) == 4 * 5);
  CHECK(stats.blocks.count(TileKind::mixed) > 0);  // those along the frame's edge, at least
  CHECK(stats.blocks.count(TileKind::flat) + stats.blocks.count(TileKind::curved) +
            stats.blocks.count(TileKind::mixed) ==
        5 * 5);
  long changed = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool touched = x >= 128 && !(x == 150 && y == 20) && !(x == 160 && y == 30);
        if (!touched) {
          REQUIRE(result.bits(x, y, c) == beauty.bits(x, y, c));
          REQUIRE(scattered.bits(x, y, c) == light.bits(x, y, c));
        } else {
          REQUIRE(std::isfinite(scattered.get(x, y, c)));  // Light that is not finite does not spread.
          changed += result.bits(x, y, c) != beauty.bits(x, y, c) ? 1 : 0;
        }
      }
    }
  }
  CHECK(changed > 10000);
}

TEST_CASE("where little of the frame scatters its tiles are lower, and the light is the same", "[skipping][tiles]") {
  const Device device = Device::open("", 1);
  constexpr int width = 530;
  constexpr int height = 1030;
  std::vector<float> light(std::size_t{width} * height * 3);
  std::vector<std::uint8_t> ids(std::size_t{width} * height);
  Random random(801);
  for (float& value : light) value = static_cast<float>(random.uniform(0, 2));
  Frame frame{.width = width, .height = height, .camera = Camera::orthographic(4, 4)};
  frame.material = {.host = ids.data(), .buffer = nullptr, .layout = {.format = Format::u8}};
  const std::vector<dermis::Material> skin{{1, dermis::preset("skin").profile}};
  std::vector<int> heights;
  for (const int scattering_rows : {height, 90}) {
    for (int i = 0; i < width * height; ++i) ids[i] = i / width < scattering_rows ? 1 : 0;
    std::vector<float> by_itself = light;
    std::vector<float> fixed = light;
    for (std::vector<float>* in_place : {&by_itself, &fixed}) {
      frame.light.host = in_place->data();
      frame.scattered.host = in_place->data();
      const Plan plan(device, skin, FrameDescription::of(frame), {.tile_height = in_place == &fixed ? 48 : 0});
      const Stats stats = plan.run(frame);
      CHECK(stats.tiles.rows == (height + stats.tiles.tile_height - 1) / stats.tiles.tile_height);
      REQUIRE(stats.tiles.kinds.size() == static_cast<std::size_t>(stats.tiles.columns) * stats.tiles.rows);
      const int tile_rows = (scattering_rows + stats.tiles.tile_height - 1) / stats.tiles.tile_height;
      CHECK(stats.count(TileKind::flat) == static_cast<std::int64_t>(stats.tiles.columns) * tile_rows);
      if (in_place == &by_itself) heights.push_back(stats.tiles.tile_height);
    }
    REQUIRE(std::memcmp(by_itself.data(), fixed.data(), fixed.size() * sizeof(float)) == 0);
  }
  CHECK(heights[1] < heights[0]);
}

TEST_CASE("light does not cross from one material to another", "[skipping]") {
  const Device device = Device::open();
  constexpr int width = 90;
  constexpr int height = 40;
  std::vector<float> light(width * height * 3), scattered(light.size());
  std::vector<std::uint8_t> ids(width * height);
  for (int i = 0; i < width * height; ++i) {
    const bool left = i % width < 41;
    ids[i] = left ? 1 : 2;
    light[3 * i] = left ? 1.0F : 0.0F;
    light[3 * i + 2] = left ? 0.0F : static_cast<float>(i % 7);
  }
  Frame frame{.width = width, .height = height, .light = {.host = light.data()}, .camera = Camera::orthographic(4, 4)};
  frame.material = {.host = ids.data(), .buffer = nullptr, .layout = {.format = Format::u8}};
  frame.scattered.host = scattered.data();
  for (const double jitter : {0.0, 1.0}) {
    Plan(device, {{1, dermis::preset("skin").profile}, {2, dermis::preset("marble").profile}},
         FrameDescription::of(frame), {.jitter = jitter})
        .run(frame);
    for (int i = 0; i < width * height; ++i) {
      REQUIRE(scattered[3 * i + (ids[i] == 1 ? 2 : 0)] == 0);
      if (ids[i] == 1) REQUIRE(scattered[3 * i] == Approx(1).epsilon(2e-6));
    }
  }
}

TEST_CASE("uniform light is copied, and what follows it in a run does not depend on earlier runs", "[skipping]") {
  const Device device = Device::open();
  constexpr int width = 150;
  constexpr int height = 61;
  const std::vector<dermis::Material> skin = {{0, dermis::preset("skin").profile}};
  std::vector<float> light(width * height * 3), depth(width * height), scattered(light.size()), expected(light.size());
  Frame frame{.width = width, .height = height, .camera = Camera::perspective(400, 300, 75, 30)};
  frame.light.host = light.data();
  frame.depth.host = depth.data();
  const FrameDescription description = FrameDescription::of(frame);
  const Plan plan(device, skin, description);
  const Plan plain(device, skin, description, {.skip_uniform_light = false});
  Random random(801);
  for (int run = 0; run < 6; ++run) {
    // Near and far take different taps, and so do the passes, as pixels are not square. What a run under varied light
    // leaves in memory must not reach the next: there one pixel is lit otherwise, but not the first row of its blocks.
    const bool is_varied = run % 2 == 0;
    std::fill(depth.begin(), depth.end(), is_varied ? 200.0F : 400.0F);
    for (float& value : light) value = is_varied ? static_cast<float>(random.uniform(0, 1)) : 1;
    const int row = 16 * random.integer(0, 2) + random.integer(1, 12);
    light[3 * (row * width + random.integer(0, width - 1))] = 100;
    frame.scattered.host = scattered.data();
    plan.run(frame);
    frame.scattered.host = expected.data();
    plain.run(frame);
    for (std::size_t i = 0; i < light.size(); ++i) {
      CAPTURE(run, row, i);
      // Sums of 25 weights and values of one sign, divided by the sum of the weights, in float32: two passes.
      REQUIRE(scattered[i] == Approx(expected[i]).epsilon(1e-5));
    }
  }
}

TEST_CASE("progress goes to 1 and can stop a run", "[skipping]") {
  const Device device = Device::open();
  std::vector<float> light(64 * 64 * 3, 1.0F), scattered(light.size(), -1.0F);
  light[3 * (64 * 30 + 30)] = 50;
  Frame frame{.width = 64, .height = 64, .light = {.host = light.data()}, .camera = Camera::orthographic(4, 4)};
  frame.scattered.host = scattered.data();
  const Plan plan(device, {{0, dermis::preset("skin").profile}}, FrameDescription::of(frame),
                  {.method = dermis::Method::exact});
  double last = 0;
  plan.run(frame, [&](double share) {
    CHECK(share > last);
    last = share;
    return true;
  });
  CHECK(last == 1);
  CHECK(scattered[0] == Approx(1).epsilon(0.1));

  std::fill(scattered.begin(), scattered.end(), -1.0F);
  int calls = 0;
  plan.run(frame, [&](double) {
    ++calls;
    return false;
  });
  CHECK(calls == 1);
  CHECK(std::all_of(scattered.begin(), scattered.end(), [](float value) { return value == -1; }));
}

TEST_CASE("a channel that spreads less than half a pixel keeps its bits, and is counted", "[skipping]") {
  const Device device = Device::open();
  const dermis::TapsDesign design{.rank = 2, .count = 11};
  const dermis::Profile& skin = dermis::preset("skin").profile;
  const dermis::Taps taps = dermis::make_taps(skin, design);
  constexpr int width = 80;  // All blocks are whole.
  constexpr int height = 41;
  // Blue spreads 0.4 px, the others farther.
  const double px_per_mm = 0.4 / (taps.radius_mm * static_cast<double>(taps.relative_width[2]));
  REQUIRE(taps.relative_width[1] > 1.3F * taps.relative_width[2]);
  Random random(820);
  std::vector<float> light, scattered(static_cast<std::size_t>(width) * height * 3);
  for (std::size_t i = 0; i < scattered.size(); ++i) light.push_back(static_cast<float>(random.uniform(0, 1)));
  std::vector<float> depth;
  for (int i = 0; i < width * height; ++i) depth.push_back(0.002F * static_cast<float>((i % width) * (i % width)));
  for (const bool has_depth : {false, true}) {
    Frame frame{.width = width,
                .height = height,
                .light = {.host = light.data()},
                .depth = {.host = has_depth ? depth.data() : nullptr},
                .camera = Camera::orthographic(px_per_mm, px_per_mm)};
    frame.scattered.host = scattered.data();
    const Stats stats = Plan(device, {{0, skin}}, FrameDescription::of(frame), {.taps = design}).run(frame);
    CHECK(stats.channels_narrow == width * height);
    CHECK(stats.pixels_flat > 0);
    long changed = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      if (i % 3 == 2) {
        REQUIRE(scattered[i] == light[i]);
      } else {
        changed += scattered[i] != light[i] ? 1 : 0;
      }
    }
    CHECK(changed > width * height);
  }
}
