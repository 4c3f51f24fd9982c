// What plans of one device share: programs and taps, for equal profiles, designs and options only.
#include <array>
#include <string>
#include <thread>
#include <vector>

#include "dermis/plan.hpp"
#include "opencl/device_cache.hpp"
#include "opencl/program.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

using dermis::Device;
using dermis::FitKey;
using dermis::FrameDescription;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;

namespace {

constexpr int width = 61;
constexpr int height = 43;
constexpr std::size_t values = 3UL * width * height;

/// Returns random light on pixels of a sixth of a millimetre.
std::vector<float> random_light(unsigned salt) {
  Random random(salt);
  std::vector<float> light(values);
  for (float& value : light) value = static_cast<float>(random.uniform(0, 4));
  return light;
}

std::vector<float> run(const Plan& plan, const std::vector<float>& light) {
  std::vector<float> scattered(values);
  const auto stats = plan.run({.width = width,
                               .height = height,
                               .light = {.host = light.data()},
                               .camera = dermis::Camera::orthographic(6, 6),
                               .scattered = {.host = scattered.data()}});
  REQUIRE(stats.pixels_scattered == width * height);
  REQUIRE(scattered != light);
  return scattered;
}

/// Returns a profile that equals every other one, but is no copy of it.
Profile made_anew() { return Profile::burley({1.5, 0.5, 0.25}); }

Plan plan_of(const Device& device, const Profile& profile, int count) {
  return Plan(device, {{.profile = profile}}, {}, {.taps = {.rank = 2, .count = count}});
}

/// Returns the taps that a device keeps for a design; `made` counts those that it has to make.
const dermis::Taps* kept_taps(const Device& device, const Profile& profile, int count, int& made) {
  const dermis::TapsDesign design{.rank = 2, .count = count};
  return dermis::cache_of(device)
      .taps
      .get({profile, design},
           [&] {
             ++made;
             return std::make_shared<const dermis::Taps>(dermis::make_taps(profile, design));
           })
      .get();
}

}  // namespace

TEST_CASE("equal plans share what they are made of, and give the same bits", "[plan][sharing]") {
  const Device device = Device::open();
  const std::vector<float> light = random_light(7001);
  const std::vector<float> first = run(plan_of(device, made_anew(), 9), light);
  int made = 0;
  const auto* taps = kept_taps(device, made_anew(), 9, made);
  CHECK(made == 0);
  const Device copy = device;
  CHECK(run(plan_of(copy, made_anew(), 9), light) == first);
  CHECK(kept_taps(copy, made_anew(), 9, made) == taps);
  CHECK(made == 0);
  // Another device makes taps of its own.
  const Device other = Device::open();
  CHECK(run(plan_of(other, made_anew(), 9), light) == first);
  CHECK(kept_taps(other, made_anew(), 9, made) != taps);
  CHECK(made == 0);
}

TEST_CASE("plans of other profiles, designs and options share nothing that differs", "[plan][sharing]") {
  const Device device = Device::open();
  const std::vector<float> light = random_light(7002);
  const Profile other = Profile::burley({1.5, 0.5, 0.3});
  const std::vector<float> first = run(plan_of(device, made_anew(), 9), light);
  int made = 0;
  kept_taps(device, other, 9, made);
  kept_taps(device, made_anew(), 11, made);
  CHECK(made == 2);
  // The results are those of a device that never made the first.
  const Device fresh = Device::open();
  const std::vector<float> of_other = run(plan_of(device, other, 9), light);
  CHECK(of_other != first);
  CHECK(of_other == run(plan_of(fresh, other, 9), light));
  const std::vector<float> of_count = run(plan_of(device, made_anew(), 11), light);
  CHECK(of_count != first);
  CHECK(of_count == run(plan_of(fresh, made_anew(), 11), light));
  const Options turned{.taps = {.rank = 2, .count = 9}, .jitter = 0.5};
  const std::vector<float> of_turned = run(Plan(device, {{.profile = made_anew()}}, {}, turned), light);
  CHECK(of_turned != first);
  CHECK(of_turned == run(Plan(fresh, {{.profile = made_anew()}}, {}, turned), light));
  CHECK(run(plan_of(device, made_anew(), 9), light) == first);
}

TEST_CASE("a program is built once for its files and options", "[plan][sharing]") {
  const Device device = Device::open();
  const std::string options =
      "-cl-std=CL1.2 -DMATERIALS=1 -DHAS_DEPTH=0 -DHAS_MATERIAL=0 -DHAS_MASK=0 -DHAS_ALBEDO=0 "
      "-DPIXEL_WIDTH=0 -DJITTER=0 -DSHEARED=0 -DV=16 -DFLATNESS=0.1f";
  const auto built = [&](const std::string& more) {
    return dermis::build_program(device, {"classify/classify.cl"}, options + more)();
  };
  const auto* first = built("");
  CHECK(built("") == first);
  CHECK(built(" -DUNUSED=1") != first);
}

TEST_CASE("threads make equal and different plans at the same time", "[plan][sharing]") {
  const Device device = Device::open();
  const std::vector<float> light = random_light(7003);
  constexpr std::array counts = {5, 7};
  std::array<std::vector<float>, 6> results;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < results.size(); ++i) {
    threads.emplace_back([&, i] { results[i] = run(plan_of(device, made_anew(), counts[i % 2]), light); });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(results[0] != results[1]);
  for (std::size_t i = 2; i < results.size(); ++i) CHECK(results[i] == results[i % 2]);
}

TEST_CASE("profiles are equal if they are made of the same numbers", "[profile][sharing]") {
  const auto table = [](double last) {
    return Profile::tabulated({{0, {3, 2, 1}}, {1, {1, 1, 0.5}}, {2, {0, 0.1, last}}});
  };
  const auto all = [&] {
    return std::vector<Profile>{Profile::burley({1, 2, 3}),
                                Profile::burley({1, 2, 3.5}),
                                Profile::burley_cycles({1, 2, 3}),
                                Profile::burley_cycles({1, 2, 3}, {0, 0, 0}),
                                Profile::gaussians({{1, {1, 1, 1}}, {2, {0.5, 1, 2}}}),
                                Profile::gaussians({{1, {1, 1, 1}}, {2, {0.5, 1, 3}}}),
                                Profile::artist({1, 1, 1}, {2, 2, 2}, 0.5),
                                Profile::dipole({1, 1, 1}, {0.1, 0.2, 0.3}),
                                Profile::better_dipole({1, 1, 1}, {0.1, 0.2, 0.3}),
                                table(0),
                                table(0.01)};
  };
  const std::vector<Profile> ones = all();
  const std::vector<Profile> others = all();
  for (std::size_t i = 0; i < ones.size(); ++i) {
    for (std::size_t j = 0; j < others.size(); ++j) {
      CAPTURE(i, j);
      CHECK((ones[i] == others[j]) == (i == j));
    }
  }
}
