// Options::sums_weights: the share of a profile's weight that lies on what the camera sees.
#include <cmath>
#include <vector>

#include "dermis/plan.hpp"
#include "support/catch.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;

namespace {

constexpr int width = 160;
constexpr int height = 96;
constexpr int edge_px = 80;
constexpr double px_per_mm = 4;

/// A plane across the view, of which only the part left of `edge_px` is of the material, under a light of 1.
struct HalfPlane {
  std::vector<float> light = std::vector<float>(3 * width * height, 1.0F);
  std::vector<float> depth = std::vector<float>(width * height, 100.0F);
  std::vector<float> material = std::vector<float>(width * height, 0.0F);

  HalfPlane() {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < edge_px; ++x) material[static_cast<std::size_t>(y * width + x)] = 1;
    }
  }

  std::vector<float> scattered(const Profile& profile, const Options& options) const {
    std::vector<float> result(light.size());
    const Frame frame{.width = width,
                      .height = height,
                      .light = {.host = light.data()},
                      .depth = {.host = depth.data()},
                      .material = {.host = material.data()},
                      .camera = Camera::orthographic(px_per_mm, px_per_mm),
                      .mm_per_unit = 1,
                      .scattered = {.host = result.data()}};
    Plan(Device::open(), {{1, profile}}, FrameDescription::of(frame), options).run(frame);
    return result;
  }
};

}  // namespace

TEST_CASE("the sum of weights is the share of the profile that the camera sees") {
  const Profile profile = Profile::burley({0.4, 0.3, 0.2});
  const HalfPlane plane;
  // Pixels tile the plane, so that only the quadrature of the exact method is off. Taps are steps, of up to 0.15 beside
  // the centre here: half of one would be 0.08, and less is allowed.
  struct Case {
    Options options;
    double tolerance;
  };
  for (const Case& what : {Case{{.method = Method::exact, .sums_weights = true}, 1e-3},
                           Case{{.taps = {.rank = 2, .count = 33}, .sums_weights = true}, 0.04}}) {
    const std::vector<float> seen = plane.scattered(profile, what.options);
    for (int x = 20; x < edge_px; ++x) {
      const double left_mm = (x + 0.5) / px_per_mm;
      const double right_mm = (edge_px - x - 0.5) / px_per_mm;
      for (int c = 0; c < 3; ++c) {
        CAPTURE(static_cast<int>(what.options.method), x, c);
        const double share = seen[static_cast<std::size_t>(3 * (height / 2 * width + x) + c)];
        CHECK(std::abs(share - profile.strip(c, -left_mm, right_mm)) < what.tolerance);
      }
    }
    // Without it the light is divided by that sum, and stays 1.
    Options divided = what.options;
    divided.sums_weights = false;
    for (const float value : plane.scattered(profile, divided)) CHECK(value == Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("a plan does not sum weights of frames with views") {
  const FrameDescription frames{.depth = true, .views = true};
  CHECK_THROWS_WITH(Plan(Device::open(), {{0, Profile::burley({1, 1, 1})}}, frames, {.sums_weights = true}),
                    "sums_weights: got it with views, want one of the two");
}
