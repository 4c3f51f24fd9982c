// Frames that memory does not suffice for run in bands of rows: every bit is that of the whole.
#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <string>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random_frame.hpp"

using dermis::BadPixels;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Stats;

namespace {

struct Way {
  const char* name;
  Method method;
  double jitter;
  bool prefiltered;
  int width, height;
};

/// Heights are odd; texels of discs that are prefiltered are up to 256 rows high.
constexpr Way ways[] = {{"separable", Method::separable, 0, false, 57, 389},
                        {"turned taps", Method::separable, 0.6, false, 41, 589},
                        {"exact", Method::exact, 0, false, 21, 305},
                        {"disc", Method::disc, 0, false, 41, 389},
                        {"disc, prefiltered", Method::disc, 0, true, 17, 1501}};

/// A narrow frame, so that bands are higher than light goes, with some light that is not finite.
RandomFrame tall_frame(Random& random, const Way& way) {
  RandomFrame frame(random, {.width = way.width, .height = way.height, .jitter = way.jitter});
  frame.options.method = way.method;
  frame.options.disc = {.samples = 33, .prefiltered = way.prefiltered};
  // Of kernels within ten pixels no light goes farther than some sixty, turned taps included.
  double radius_mm = 0;
  for (const dermis::Material& its : frame.materials) {
    for (int c = 0; c < 3; ++c) radius_mm = std::max(radius_mm, its.profile.radius(c, 0.999));
  }
  const double px_per_mm = random.uniform(2, way.method == Method::exact ? 4 : 10) / radius_mm;
  // A camera that is no wider than usual.
  const double away_mm = std::max(100.0, way.height / px_per_mm);
  for (int y = 0; y < way.height; ++y) {
    for (int x = 0; x < way.width; ++x) {
      const double depth = frame.depth->get(x, y, 0);
      if (depth < 1e9) frame.depth->set(x, y, 0, depth + (away_mm - 100) / frame.mm_per_unit);
    }
  }
  const bool is_perspective = frame.camera.projection == dermis::Camera::Projection::perspective;
  frame.camera.scale_x = px_per_mm * (is_perspective ? away_mm : frame.mm_per_unit);
  frame.camera.scale_y = random.uniform(0.8, 1.2) * frame.camera.scale_x;
  for (int i = 0; i < 5; ++i) {
    frame.light->set(random.integer(0, way.width - 1), random.integer(0, way.height - 1), 1, INFINITY);
  }
  return frame;
}

std::vector<std::uint32_t> bits_of(const std::optional<GuardedImage>& image, const Way& way) {
  std::vector<std::uint32_t> bits;
  if (!image) return bits;
  for (int y = 0; y < way.height; ++y) {
    for (int x = 0; x < way.width; ++x) {
      for (int c = 0; c < image->channels(); ++c) bits.push_back(image->bits(x, y, c));
    }
  }
  return bits;
}

using Counts = std::vector<std::int64_t>;

/// Bad pixels are not counted in tiles that are skipped, which those of bands may not be.
Counts counts_of(const Stats& stats) {
  return {stats.pixels,
          stats.pixels_scattered,
          stats.pixels_without_material,
          stats.pixels_narrow,
          stats.pixels_flat,
          stats.channels_narrow,
          stats.tiles.kinds.empty() ? stats.pixels_bad : 0,
          stats.pixels_unlit};
}

/// Runs it where no buffer may be larger.
Stats run(const Device& device, RandomFrame& random_frame, const Options& options, std::uint64_t largest_buffer) {
  const Frame frame = random_frame.frame();
  const Device its = largest_buffer > 0 ? with_largest_buffer(device, largest_buffer) : device;
  return Plan(its, random_frame.materials, FrameDescription::of(frame), options).run(frame);
}

}  // namespace

// Two of all ways a run: each takes kernels of its own, which take seconds to build.
TEST_CASE("bands have the bits of the whole", "[bands]") {
  const auto salt = static_cast<unsigned>(8100 + GENERATE(0, 1));
  Random random(salt);
  const Way& way = ways[random.integer(0, 4)];
  const std::string type = random.coin() ? "GPU" : "CPU";
  const Device whole = Device::open();
  const Device device = type == "GPU" ? with_kernel_shape(whole, 1, type) : whole;
  RandomFrame frame = tall_frame(random, way);
  CAPTURE(test_seed(), way.name, type);
  const Stats expected = run(device, frame, frame.options, 0);
  REQUIRE(expected.bands == 1);
  const auto scattered = bits_of(frame.scattered, way);
  const auto result = bits_of(frame.result, way);

  // Down to a limit below which there are no bands.
  std::uint64_t limit = Plan::scratch_bytes(device, frame.materials, FrameDescription::of(frame.frame()), frame.options,
                                            way.width, way.height);
  int most_bands = 1;
  std::optional<Failure> failure;
  while (!failure) {
    limit = limit * 4 / 5;
    CAPTURE(limit);
    Stats stats;
    const auto run_limited = [&] { stats = run(device, frame, frame.options, limit); };
    try {
      run_limited();
    } catch (const dermis::Error&) {
      failure = failure_of(run_limited);
      continue;
    }
    CHECK(bits_of(frame.scattered, way) == scattered);
    CHECK(bits_of(frame.result, way) == result);
    CHECK(counts_of(stats) == counts_of(expected));
    CHECK((stats.blocks.kinds == expected.blocks.kinds));
    CHECK(frame.scattered->guards_intact());
    most_bands = std::max(most_bands, stats.bands);
  }
  INFO(failure->message);
  // Limits are a fifth apart, and a part of memory is the same for all bands: where the fewest rows that a band may
  // have are more than half of the frame, as those of wide exact kernels, no limit may lie between it and the frame.
  std::smatch fewest;
  REQUIRE(std::regex_search(failure->message, fewest, std::regex(" of ([0-9]+) rows buffer")));
  CHECK((most_bands > 1 || 2 * std::stoi(fewest[1]) > way.height));
  CHECK(failure->code == dermis::ErrorCode::device);
  CHECK_THAT(failure->message, Catch::Contains(" of ") && Catch::Contains(" rows buffer: got ") &&
                                   Catch::Contains(" MB, want at most ") && Catch::Contains("the largest buffer"));
}

TEST_CASE("a limit of memory makes bands, in place and out of buffers", "[bands]") {
  constexpr int width = 64;
  constexpr int height = 4001;
  const Device device = Device::open();
  Random random(8120);
  std::vector<float> light(3UL * width * height);
  for (float& value : light) value = static_cast<float>(random.uniform(0.5, 1.5));
  std::vector<float> scattered(light.size());
  Frame frame{
      .width = width, .height = height, .light = {.host = light.data()}, .camera = dermis::Camera::orthographic(1, 1)};
  frame.scattered.host = scattered.data();
  const std::vector<dermis::Material> skin = {{0, dermis::preset("skin").profile}};
  const auto plan = [&](const Options& options) { return Plan(device, skin, FrameDescription::of(frame), options); };
  plan({}).run(frame);
  const std::vector<float> expected = scattered;
  const Options limited{.device_memory_mb = 1};

  std::vector<float> in_place = light;
  frame.light.host = frame.scattered.host = in_place.data();
  const Stats stats = plan(limited).run(frame);
  CHECK(stats.bands > 3);
  CHECK(in_place == expected);
  CHECK(stats.tiles.kinds.size() == static_cast<std::size_t>(stats.tiles.columns) * stats.tiles.rows);
  CHECK((stats.tiles.kinds.empty() || stats.tiles.rows * stats.tiles.tile_height >= height));  // GPUs have none

  // Nothing is written of what ends the run before the first band is done, or of a frame with bad pixels.
  in_place = light;
  in_place[3 * width * (height - 1)] = INFINITY;
  const std::vector<float> before = in_place;
  CHECK(plan(limited).run(frame, [](double) { return false; }).pixels == 0);
  Options refusing = limited;
  refusing.bad_pixels = BadPixels::error;
  CHECK_THROWS_WITH(plan(refusing).run(frame), Catch::Contains("light: got 1 pixels that are not finite"));
  CHECK(in_place == before);

  const cl::Context context(device.context(), true);
  const cl::CommandQueue queue(context, cl::Device(device.id(), true));
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, light.size() * sizeof(float),
                          light.data());
  frame.light = {.buffer = buffer()};
  frame.scattered = {.buffer = buffer()};
  const Plan its_plan = plan(limited);
  // A matcher refers to its parts: they are one.
  const auto refused = Catch::Matches(
      "device memory of 4001 rows: got [0-9.]+ MB, want at most 1.0 MB, as "
      "device_memory_mb says");
  CHECK_THROWS_WITH(its_plan.run(frame), refused);
  CHECK_THROWS_WITH(its_plan.enqueue(frame, queue()), refused);
}
