// The exact method equals the oracle's surface integral.
#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/materials.hpp"
#include "dermis/oracle/scenes.hpp"
#include "dermis/plan.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/compare_light.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Plan;
using dermis::Profile;
namespace oracle = dermis::oracle;

TEST_CASE("the exact method equals the surface integral on the analytic scenes", "[exact]") {
  const Device device = Device::open();
  const dermis::Options options{.method = Method::exact};
  const Profile burley = Profile::burley({1, 0.7, 0.4});
  for (const Profile& profile : {dermis::preset("skin").profile, burley.projected()}) {
    const std::vector<dermis::Material> materials = {{1, profile}, {2, Profile::burley_cycles({3, 6, 2})}};
    const auto as_oracle = dermis::oracle::materials_of(materials, options.taps);
    for (const oracle::SceneInfo& info : oracle::scenes()) {
      for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
        const oracle::Scene scene = oracle::scene(info.name, 45, 31, 3, projection);
        std::vector<float> scattered(scene.light.size());
        Frame frame = scene.frame();
        frame.scattered.host = scattered.data();
        const oracle::Reference expected = oracle::surface_integral(frame, as_oracle, options);
        const auto stats = Plan(device, materials, FrameDescription::of(frame), options).run(frame);

        const oracle::Picture picture = picture_of(scene.width, scene.height, scattered);
        const oracle::Picture before = picture_of(scene.width, scene.height, scene.light);
        const oracle::Difference difference = oracle::compare(picture, expected.scattered);
        CAPTURE(info.name, profile.is_projected(), static_cast<int>(projection), difference.max, difference.max_x,
                difference.max_y);
        CHECK(stats.pixels_scattered > 200);
        CHECK(difference.relative_l2 <= 1e-5);
        CHECK(difference.max <=
              1e-5 * *std::max_element(expected.scattered.values.begin(), expected.scattered.values.end()));
        CHECK(oracle::compare(before, expected.scattered).relative_l2 > 1e-2);  // Scattering did change the picture.
      }
    }
  }
}

TEST_CASE("a projected profile tells where surfaces bend, and on planes alone it does not", "[exact]") {
  const Device device = Device::open();
  const auto off = [&](const char* name) {
    const oracle::Scene scene = oracle::scene(name, 45, 31, 3);
    std::vector<oracle::Picture> pictures;
    const Profile profile = Profile::burley({1, 0.7, 0.4});
    for (const Profile& its : {profile, profile.projected()}) {
      std::vector<float> scattered(scene.light.size());
      Frame frame = scene.frame();
      frame.scattered.host = scattered.data();
      Plan(device, {{1, its}, {2, its}}, FrameDescription::of(frame), {.method = Method::exact}).run(frame);
      pictures.push_back(picture_of(scene.width, scene.height, scattered));
    }
    return oracle::compare(pictures[0], pictures[1]).relative_l2;
  };
  CHECK(off("touching") < 1e-3);  // weights of a plane sum to 1 to within the quadrature
  CHECK(off("sphere") > 3e-3);
}

TEST_CASE("the exact method does not depend on vector width or work-items", "[exact]") {
  const Device device = Device::open();
  const oracle::Scene scene = oracle::scene("sphere", 45, 31, 3);
  const std::vector<dermis::Material> materials = {{1, dermis::preset("skin").profile}};
  const auto filtered = [&](const Device& shaped) {
    std::vector<float> scattered(scene.light.size());
    Frame frame = scene.frame();
    frame.scattered.host = scattered.data();
    Plan(shaped, materials, FrameDescription::of(frame), {.method = Method::exact}).run(frame);
    return scattered;
  };
  const std::vector<float> expected = filtered(device);
  CHECK(expected != scene.light);
  CHECK(filtered(with_kernel_shape(device, 4, "CPU")) == expected);
  CHECK(filtered(with_kernel_shape(device, 1, "GPU")) == expected);
}

TEST_CASE("separable comes near exact on a plane, and nearer with more taps", "[exact]") {
  const Device device = Device::open();
  const oracle::Scene scene = oracle::scene("step", 120, 60, 3);
  const std::vector<dermis::Material> materials = {{1, dermis::preset("marble").profile}};
  const auto filtered = [&](const dermis::Options& options) {
    std::vector<float> scattered(scene.light.size());
    Frame frame = scene.frame();
    frame.scattered.host = scattered.data();
    Plan(device, materials, FrameDescription::of(frame), options).run(frame);
    return picture_of(scene.width, scene.height, scattered);
  };
  // Pixels near the frame's edges do not count, as each method normalises there in its own way.
  oracle::Picture inside(scene.width, scene.height, 1);
  for (int y = 25; y < 35; ++y) {
    for (int x = 30; x < 90; ++x) inside(x, y) = 1;
  }
  const oracle::Picture exact = filtered({.method = Method::exact});
  const auto error_of = [&](int count) {
    const dermis::TapsDesign design{
        .model = dermis::Model::pre_integrated, .count = count, .placement = dermis::Placement::importance};
    return oracle::compare(filtered({.taps = design}), exact, inside).relative_l2;
  };
  const double error_7 = error_of(7);
  const double error_25 = error_of(25);
  const double error_63 = error_of(63);
  CAPTURE(error_7, error_25, error_63);
  CHECK(error_25 < error_7 / 3);
  CHECK(error_63 <= error_25);
  CHECK(error_63 < 1e-3);  // Pre-integrated kernels reproduce straight edges.
}
