// Every kernel of the separable method equals the oracle with the same taps, on random frames, within the bound that
// the oracle derives from float rounding.
#include "dermis/oracle/materials.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"
#include "support/tally.hpp"

using dermis::Device;
using dermis::FrameDescription;
using dermis::Plan;
namespace oracle = dermis::oracle;

TEST_CASE("kernels equal the oracle within float rounding", "[kernels]") {
  const Device device = Device::open();
  constexpr int sizes[][2] = {{1, 1}, {7, 5}, {257, 89}, {16, 16}, {33, 64}, {100, 3}, {2, 90}, {129, 40}};
  Tally tally;
  std::int64_t scattered = 0;
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
    const auto materials = dermis::oracle::materials_of(random_frame.materials, random_frame.options.taps);
    const oracle::Reference expected = oracle::separable(frame, materials, random_frame.options);

    const Plan plan(device, random_frame.materials, FrameDescription::of(frame), random_frame.options);
    scattered += plan.run(frame).pixels_scattered;

    compare(random_frame, expected, tally);
  }
  INFO("worst error / bound " << tally.worst << ", " << tally.loose << " of " << tally.values << " bounds are loose");
  // The filter did something, in frames whose kernels are not all narrower than half a pixel.
  CHECK(scattered > 1000);
  CHECK(tally.changed > scattered / 2);
  CHECK(tally.worst > 1e-3);  // The bound is of the order of the errors.
  // Bounds are tight, but where terms of high rank cancel, or where float32 cannot tell which column a tap of the
  // vertical pass falls on, so that the bound admits both.
  CHECK(tally.loose < tally.values / 500);
  CHECK(tally.largest_bound < 1);  // It is the weight of a tap times the range of the light.
}
