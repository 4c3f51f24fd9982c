// Every kernel of the separable method against the oracle over the same taps, on random frames, within the bound that
// the oracle derives from float rounding.
#include "catch.hpp"
#include "core/oracle_material.hpp"
#include "core/random_frame.hpp"
#include "dermis/plan.hpp"

using dermis::Device;
using dermis::FrameDescription;
using dermis::Plan;
namespace oracle = dermis::oracle;

namespace {

struct Tally {
  double worst = 0;          ///< error / bound
  double largest_bound = 0;  ///< relative to the largest value
  long values = 0;
  long loose = 0;    ///< of which the bound is more than a hundredth of the largest one of the frame
  long changed = 0;  ///< that differ from the light
};

void compare(const GuardedImage& output, const oracle::Picture& expected, const oracle::Picture& bound, Tally& tally) {
  double largest = 0;
  for (const double value : expected.values) largest = std::max(largest, std::abs(value));
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = expected(x, y, c);
        const bool half = output.layout().format == dermis::Format::f16;
        const double allowed = bound(x, y, c) + (half ? half_rounding(value) : 0);
        const double error = std::abs(output.get(x, y, c) - value);
        tally.largest_bound = std::max(tally.largest_bound, bound(x, y, c) / largest);
        ++tally.values;
        if (bound(x, y, c) > 0.01 * largest) ++tally.loose;
        if (!half) tally.worst = std::max(tally.worst, error / allowed);
        if (!(error <= allowed)) {
          CAPTURE(x, y, c, value, output.get(x, y, c), error, allowed);
          REQUIRE(error <= allowed);
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("kernels equal the oracle within float rounding", "[kernels]") {
  const Device device = Device::open();
  constexpr int sizes[][2] = {{1, 1}, {7, 5}, {257, 89}, {16, 16}, {33, 64}, {100, 3}, {2, 90}, {129, 40}};
  Tally tally;
  for (unsigned round = 0; round < 10; ++round) {
    Random random(round);
    const auto& [width, height] = sizes[round % 8];
    RandomFrame random_frame(random, {.width = width, .height = height});
    const dermis::Frame frame = random_frame.frame();
    CAPTURE(test_seed(), round, width, height);
    for (const dermis::Material& material : random_frame.materials) {
      const dermis::TapsDesign& design = material.taps.value_or(random_frame.options.taps);
      UNSCOPED_INFO("model " << static_cast<int>(design.model) << ", rank " << design.rank << ", " << design.count
                             << " taps, placement " << static_cast<int>(design.placement));
    }
    const auto materials = oracle_materials(random_frame.materials, random_frame.options.taps);
    const oracle::Reference expected = oracle::separable(frame, materials, random_frame.options);

    const Plan plan(device, random_frame.materials, FrameDescription::of(frame), random_frame.options);
    plan.run(frame);

    compare(*random_frame.scattered, expected.scattered, expected.scattered_bound, tally);
    CHECK(random_frame.scattered->guards_intact());
    if (random_frame.result) {
      compare(*random_frame.result, expected.result, expected.result_bound, tally);
      CHECK(random_frame.result->guards_intact());
    }
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (expected.touched(x, y) == 0) continue;
        for (int c = 0; c < 3; ++c) {
          if (std::abs(expected.scattered(x, y, c) - random_frame.light->get(x, y, c)) > 1e-3) ++tally.changed;
        }
      }
    }
  }
  INFO("worst error / bound " << tally.worst << ", " << tally.loose << " of " << tally.values << " bounds are loose");
  CHECK(tally.changed > 10000);  // the filter did something
  CHECK(tally.worst > 1e-3);     // the bound is of the order of the errors
  // And it says something, but where terms of high rank cancel, or where float32 cannot tell which column a tap of the
  // vertical pass falls on, so that the bound admits both.
  CHECK(tally.loose < tally.values / 500);
  CHECK(tally.largest_bound < 1);  // the weight of a tap times the range of the light
}
