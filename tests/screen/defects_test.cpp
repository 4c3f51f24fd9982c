// What filters in games get wrong, one test each: black where a channel is zero, halos and leaks at edges, blur that
// depends on taps, aspect, units or what is painted, depth tests that fail.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "dermis/oracle/compare.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/compare_light.hpp"
#include "support/random_frame.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Lighting;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;

namespace {

constexpr float background = 1e10F;  // as Cycles writes it
const Options taps_17{.taps = {.rank = 2, .count = 17}};

/// A frame whose images are functions of the pixel; one scene unit to the millimetre.
struct Shot {
  int width;
  int height;
  Camera camera;
  std::vector<float> light, depth, ids, scattered;
  double mm_per_unit = 1;

  Shot(int its_width, int its_height, const Camera& its_camera)
      : width(its_width),
        height(its_height),
        camera(its_camera),
        light(3 * pixels(), 1),
        depth(pixels(), 100),
        ids(pixels(), 1),
        scattered(3 * pixels()) {}

  std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }

  void set(std::vector<float>& image, const std::function<double(int x, int y)>& value) const {
    const std::size_t channels = image.size() / pixels();
    for (std::size_t i = 0; i < image.size(); ++i) {
      const auto pixel = static_cast<int>(i / channels);
      image[i] = static_cast<float>(value(pixel % width, pixel / width));
    }
  }

  Frame frame() {
    Frame frame{.width = width, .height = height, .camera = camera, .mm_per_unit = mm_per_unit};
    frame.light.host = light.data();
    frame.depth.host = depth.data();
    frame.material.host = ids.data();
    frame.scattered.host = scattered.data();
    return frame;
  }

  const std::vector<float>& filter(const Profile& profile = dermis::preset("skin").profile,
                                   const Options& options = taps_17) {
    const Frame its = frame();
    Plan(Device::open(), {{1, profile}}, FrameDescription::of(its), options).run(its);
    return scattered;
  }
};

const Camera four_per_mm = Camera::orthographic(4, 4);

bool in_disc(int x, int y, double radius) { return std::hypot(x - 60, y - 45) < radius; }

/// A disc of the same material far in front of a plane.
Shot disc_before_plane(double disc_light, double plane_light) {
  Shot shot(120, 90, four_per_mm);
  shot.set(shot.depth, [](int x, int y) { return in_disc(x, y, 25) ? 100 : 160; });
  shot.set(shot.light, [=](int x, int y) { return in_disc(x, y, 25) ? disc_light : plane_light; });
  return shot;
}

/// Mean distance from the middle, px, that the red light of one lit pixel goes along x and along y.
std::array<double, 2> mean_distances_px(Shot& shot, const Profile& profile, const Options& options) {
  shot.set(shot.light, [&](int x, int y) { return x == shot.width / 2 && y == shot.height / 2 ? 1 : 0; });
  const std::vector<float>& scattered = shot.filter(profile, options);
  std::array<double, 2> sums{};
  double all = 0;
  for (int y = 0; y < shot.height; ++y) {
    for (int x = 0; x < shot.width; ++x) {
      const auto light = static_cast<double>(scattered[3 * shot.at(x, y)]);
      all += light;
      sums[0] += light * std::abs(x - shot.width / 2);
      sums[1] += light * std::abs(y - shot.height / 2);
    }
  }
  CHECK(all == Approx(1).epsilon(0.01));  // the kernel is wider than the frame, whose edges take no light out
  return {sums[0] / all, sums[1] / all};
}

}  // namespace

TEST_CASE("a channel that does not spread keeps its light, and the others spread", "[defects]") {
  Shot shot(64, 48, four_per_mm);
  shot.set(shot.light, [](int x, int y) { return x == 32 && y == 24 ? 1 : 0; });
  shot.filter(Profile::burley({1, 1e-6, 1e-6}));
  const float* middle = &shot.scattered[3 * shot.at(32, 24)];
  CHECK(middle[0] < 0.5F);
  CHECK(middle[0] > 0);
  CHECK(middle[1] == 1);
  CHECK(middle[2] == 1);
  CHECK(shot.scattered[3 * shot.at(34, 24)] > 0);
  CHECK(shot.scattered[3 * shot.at(34, 24) + 1] == 0);
}

TEST_CASE("constant light stays constant up to every edge, and beyond it nothing changes", "[defects]") {
  Shot shot = disc_before_plane(1, 1);
  shot.set(shot.ids, [](int x, int y) { return in_disc(x, y, 25) || y > 60 ? 1 : 0; });
  shot.set(shot.light, [](int x, int y) { return in_disc(x, y, 25) || y > 60 ? 1 : 0.25 + 0.001 * x; });
  shot.filter();
  for (std::size_t i = 0; i < shot.scattered.size(); ++i) {
    if (shot.ids[i / 3] == 1) {
      REQUIRE(shot.scattered[i] == Approx(1).epsilon(2e-6));
    } else {
      REQUIRE(shot.scattered[i] == shot.light[i]);
    }
  }
}

TEST_CASE("no light comes from a surface of the same material far behind, nor from one far in front", "[defects]") {
  for (const bool is_disc_dark : {true, false}) {
    Shot shot = disc_before_plane(is_disc_dark ? 0 : 1, is_disc_dark ? 1 : 0);
    shot.filter();
    float most = 0;
    for (std::size_t i = 0; i < shot.scattered.size(); ++i) {
      if (shot.light[i] == 0) most = std::max(most, std::abs(shot.scattered[i]));
    }
    CAPTURE(is_disc_dark);
    CHECK(most == 0);
  }
}

TEST_CASE("a wider profile carries more light over a step of depth", "[defects]") {
  double before = 0;
  for (const double d_mm : {0.5, 1.0, 2.0, 4.0}) {
    Shot shot(120, 48, four_per_mm);
    shot.set(shot.depth, [](int x, int) { return x < 60 ? 100 : 101; });
    shot.set(shot.light, [](int x, int) { return x < 60 ? 1 : 0; });
    shot.filter(Profile::burley({d_mm, d_mm, d_mm}));
    double carried = 0;
    for (int x = 60; x < 120; ++x) carried += static_cast<double>(shot.scattered[3 * shot.at(x, 24)]);
    CAPTURE(d_mm);
    CHECK(carried > 1.5 * before);
    before = carried;
  }
}

TEST_CASE("blur is as wide with few taps as with many, across as down, and with pixels that are not square",
          "[defects]") {
  const Profile profile = Profile::burley({1, 1, 1});
  Shot square(161, 121, four_per_mm);
  const auto many = mean_distances_px(square, profile, {.taps = {.rank = 2, .count = 65}});
  CHECK(many[0] == Approx(many[1]).epsilon(0.02));
  for (const int count : {11, 17, 33}) {
    const auto few = mean_distances_px(square, profile, {.taps = {.rank = 2, .count = count}});
    CAPTURE(count);
    CHECK(few[0] == Approx(many[0]).epsilon(0.12));
  }
  for (const auto& [width, height] : {std::pair{161, 91}, std::pair{91, 161}}) {
    Shot shot(width, height, four_per_mm);
    const auto of_frame = mean_distances_px(shot, profile, taps_17);
    CHECK(of_frame[0] == Approx(of_frame[1]).epsilon(0.01));
  }
  Shot anamorphic(241, 121, Camera::orthographic(6, 3));
  const auto stretched = mean_distances_px(anamorphic, profile, {.taps = {.rank = 2, .count = 33}});
  CHECK(stretched[0] / 6 == Approx(stretched[1] / 3).epsilon(0.03));
  CHECK(stretched[1] / 3 == Approx(many[1] / 4).epsilon(0.05));
}

TEST_CASE("a shadow's edge is scattered, the edge of a painted stripe is not", "[defects]") {
  Shot shot(80, 60, four_per_mm);
  std::vector<float> albedo(shot.light.size());
  shot.set(albedo, [](int x, int) { return x / 7 % 2 == 0 ? 0.9 : 0.2; });
  for (const bool has_shadow : {false, true}) {
    for (std::size_t i = 0; i < albedo.size(); ++i) {
      const bool is_shaded = has_shadow && static_cast<int>(i / 3) % shot.width < 40;
      shot.light[i] = is_shaded ? 0 : albedo[i];
    }
    Frame frame = shot.frame();
    frame.albedo.host = albedo.data();
    frame.beauty.host = shot.light.data();
    std::vector<float> result(shot.light.size());
    frame.result.host = result.data();
    Options options = taps_17;
    options.lighting = Lighting::lit;
    Plan(Device::open(), {{1, dermis::preset("skin").profile}}, FrameDescription::of(frame), options).run(frame);
    if (!has_shadow) {
      for (std::size_t i = 0; i < result.size(); ++i) REQUIRE(result[i] == Approx(albedo[i]).epsilon(4e-6));
    } else {
      CHECK(result[3 * shot.at(38, 30)] > 0.1F * albedo[3 * shot.at(38, 30)]);
      CHECK(result[3 * shot.at(42, 30)] < 0.95F * albedo[3 * shot.at(42, 30)]);
    }
  }
}

TEST_CASE("black light is light: a shadow takes no part out of the sums", "[defects]") {
  Shot shot(160, 60, four_per_mm);
  shot.set(shot.light, [](int x, int) { return x < 80 ? 0 : 1; });
  shot.filter();
  double all = 0;
  for (int x = 0; x < 160; ++x) all += static_cast<double>(shot.scattered[3 * shot.at(x, 30)]);
  CHECK(all == Approx(80).epsilon(1e-4));
  const auto at_edge = static_cast<double>(shot.scattered[3 * shot.at(79, 30)] + shot.scattered[3 * shot.at(80, 30)]);
  CHECK(at_edge == Approx(1).epsilon(1e-4));
}

TEST_CASE("antialiased edges leave no fringe", "[defects]") {
  // Between a surface and what lies behind it pixels have a mixed depth, and the mean of two ids.
  const auto filtered = [](double edge_id, double edge_depth, double behind) {
    Shot shot(96, 64, four_per_mm);
    shot.set(shot.ids, [=](int x, int) { return x < 48 ? 1 : x == 48 ? edge_id : 0; });
    shot.set(shot.depth, [=](int x, int) { return x < 48 ? 100 : x == 48 ? edge_depth : behind; });
    Random random(900);
    for (float& value : shot.light) value = static_cast<float>(random.uniform(0.5, 1));
    for (std::size_t y = 0; y < 64; ++y) shot.light[3 * (96 * y + 48)] = 7;
    shot.filter();
    for (std::size_t i = 0; i < shot.scattered.size(); ++i) {
      if (i / 3 % 96 >= 48) REQUIRE(shot.scattered[i] == shot.light[i]);
    }
    return shot.scattered;
  };
  const std::vector<float> clean = filtered(0, 100, background);
  CHECK(filtered(0.5, 100, background) == clean);
  CHECK(filtered(0.5, 5e9, background) == clean);
  CHECK(filtered(0.5, 5e10, 1e11) == clean);
  CHECK(filtered(0, 1e11, 1e11) == clean);
}

TEST_CASE("a pixel of a mixed depth between two surfaces of one material leaves no fringe", "[defects]") {
  const auto filtered = [](bool is_mixed) {
    Shot shot(96, 64, four_per_mm);
    shot.set(shot.depth, [](int x, int) { return x < 48 ? 100 : x == 48 ? 130 : 160; });
    shot.set(shot.ids, [=](int x, int) { return x == 48 && !is_mixed ? 0 : 1; });
    shot.set(shot.light, [](int x, int) { return x < 48 ? 0.2 : x == 48 ? 0.6 : 1; });
    return shot.filter();
  };
  const std::vector<float> clean = filtered(false);
  const std::vector<float> mixed = filtered(true);
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (i / 3 % 96 != 48) REQUIRE(mixed[i] == Approx(clean[i]).epsilon(2e-3));
  }
}

TEST_CASE("a scene in other units is the same scene", "[defects]") {
  const auto filtered = [](double units_per_mm) {
    Shot shot(90, 70, Camera::perspective(400, 400, 45, 35));
    shot.mm_per_unit = 1 / units_per_mm;
    shot.set(shot.depth, [=](int x, int y) { return units_per_mm * (100 + 0.1 * x + 3 * std::sin(0.2 * y)); });
    Random random(901);
    for (float& value : shot.light) value = static_cast<float>(random.uniform(0, 1));
    return shot.filter();
  };
  const std::vector<float> in_mm = filtered(1);
  CHECK(filtered(2) == in_mm);
  CHECK(filtered(0.125) == in_mm);
  const std::vector<float> in_others = filtered(0.1);
  // Depths are rounded to 4e-6 mm, which is 2e-5 of the size of a pixel, and a block may take another level for it.
  CHECK(relative_l2(in_others, in_mm) < 5e-4);
}

TEST_CASE("narrow and wide lenses and steep surfaces come near the surface integral", "[defects]") {
  struct Case {
    double field_deg, slope;
  };
  for (const Case& of : {Case{5, 0}, Case{120, 0}, Case{120, 1}, Case{30, 5.67}}) {
    constexpr int width = 120;
    constexpr int height = 90;
    const double focal = width / 2.0 / std::tan(of.field_deg * std::numbers::pi / 360);
    const double distance = focal / 4;  // four pixels to the millimetre in the middle
    Shot shot(width, height, Camera::perspective(focal, focal, width / 2.0, height / 2.0));
    // The plane z = distance + slope y.
    shot.set(shot.depth, [&](int, int y) { return distance / (1 - of.slope * (y + 0.5 - height / 2.0) / focal); });
    shot.set(shot.ids, [&](int x, int y) {
      return shot.depth[shot.at(x, y)] > 0 && shot.depth[shot.at(x, y)] < 8 * static_cast<float>(distance) ? 1 : 0;
    });
    shot.set(shot.light,
             [](int x, int y) { return 1 + 0.5 * std::sin(0.3 * x) * std::cos(0.2 * y) + (x + y < 100 ? 0.5 : 0); });
    const std::vector<float> separable = shot.filter();
    const std::vector<float> exact = shot.filter(dermis::preset("skin").profile, {.method = Method::exact});
    double squares = 0;
    double all = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      if (shot.ids[i / 3] == 0) continue;
      squares += std::pow(static_cast<double>(separable[i] - exact[i]), 2);
      all += std::pow(static_cast<double>(exact[i]), 2);
    }
    CAPTURE(of.field_deg, of.slope);
    CHECK(all > 0);
    CHECK(std::sqrt(squares / all) < 0.02);
  }
}
