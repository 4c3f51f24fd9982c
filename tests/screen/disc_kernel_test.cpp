// The kernels of the disc method against the oracle on random frames, within the bound that it derives from float
// rounding.
#include <cmath>
#include <string>

#include "dermis/oracle/materials.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"
#include "support/tally.hpp"

using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Plan;
namespace oracle = dermis::oracle;

namespace {

/// Sets random options of the disc method.
void choose_discs(Random& random, RandomFrame& frame) {
  frame.options.method = dermis::Method::disc;
  frame.options.disc = {.samples = random.coin() ? 0 : random.integer(1, 40),
                        .tangent_plane = random.coin(),
                        .prefiltered = random.coin(),
                        .accumulate = random.coin() ? 1 : 2};
  for (dermis::Material& material : frame.materials) material.taps.reset();
}

/// Returns normals of any length, some of which are not finite or face away.
GuardedImage random_normals(Random& random, int width, int height) {
  GuardedImage normals(width, height, 3, random.coin() ? dermis::Format::f32 : dermis::Format::f16, &random);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 2; ++c) normals.set(x, y, c, random.uniform(-1, 1));
      normals.set(x, y, 2, random.integer(0, 20) == 0 ? NAN : random.uniform(-2, 0.3));
    }
  }
  return normals;
}

}  // namespace

TEST_CASE("discs equal the oracle within float rounding", "[disc][kernels]") {
  const Device device = Device::open();
  constexpr int sizes[][2] = {{1, 1}, {7, 5}, {61, 40}, {33, 28}, {70, 3}};
  Tally tally;
  for (unsigned round = 0; round < 8; ++round) {
    Random random(8000 + round);
    const auto& [width, height] = sizes[round % 5];
    RandomFrame random_frame(random, {.width = width, .height = height, .materials = 2, .jitter = 0.0});
    choose_discs(random, random_frame);
    Frame frame = random_frame.frame();
    const GuardedImage normals = random_normals(random, width, height);
    if (random.coin()) {
      frame.normal = normals.image();
      random_frame.options.curvature = false;  // Between normals that leap, float32 hardly tells it.
    }
    const dermis::DiscOptions& disc = random_frame.options.disc;
    CAPTURE(test_seed(), round, width, height, disc.samples, disc.tangent_plane, disc.prefiltered, disc.accumulate);
    const auto materials =
        dermis::oracle::materials_of(random_frame.materials, {.model = dermis::Model::pre_integrated, .count = 3});
    const oracle::Reference expected = oracle::disc(frame, materials, random_frame.options);

    Plan(device, random_frame.materials, FrameDescription::of(frame), random_frame.options).run(frame);

    compare(random_frame, expected, tally);
  }
  INFO("worst error / bound " << tally.worst << ", " << tally.loose << " of " << tally.values << " bounds are loose");
  CHECK(tally.changed > 1000);  // The filter did something.
  CHECK(tally.worst > 1e-3);    // The bound is of the order of the errors.
  // Bounds are tight, but where float32 cannot tell which pixels a sample reads.
  CHECK(tally.loose < tally.values / 50);
}
