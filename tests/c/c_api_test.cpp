// dermis.h does what dermis.hpp does, to the bit, and says what went wrong.
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/dermis.h"
#include "dermis/plan.hpp"
#include "dermis/settings.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

namespace {

template <auto release>
struct Release {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};

template <class Handle, auto release>
using Owned = std::unique_ptr<Handle, Release<release>>;

using Device = Owned<dermis_device, dermis_device_release>;
using Profile = Owned<dermis_profile, dermis_profile_release>;
using Settings = Owned<dermis_settings, dermis_settings_release>;
using FrameHandle = Owned<dermis_frame, dermis_frame_release>;
using PlanHandle = Owned<dermis_plan, dermis_plan_release>;
using StatsHandle = Owned<dermis_stats, dermis_stats_release>;

/// What a function that makes a handle makes.
template <class Handle, class Make>
Handle made(const Make& make) {
  typename Handle::pointer handle = nullptr;
  const dermis_code code = make(&handle);
  INFO(dermis_error_message());
  REQUIRE(code == DERMIS_DONE);
  return Handle(handle);
}

Device open_device() {
  return made<Device>([](dermis_device** device) { return dermis_device_open(nullptr, 0, device); });
}

Profile profile(const char* text) {
  return made<Profile>([&](dermis_profile** its) { return dermis_profile_create(text, its); });
}

Settings new_settings() {
  return made<Settings>([](dermis_settings** its) { return dermis_settings_create(its); });
}

/// A plane with a stripe of light.
struct Stripe {
  static constexpr int width = 61;
  static constexpr int height = 37;
  std::vector<float> light = std::vector<float>(3 * width * height, 0.1F);
  std::vector<float> depth = std::vector<float>(width * height, 50.0F);
  std::vector<float> scattered = std::vector<float>(3 * width * height, -1.0F);

  Stripe() {
    for (int y = 0; y < height; ++y) {
      for (int i = 60; i < 90; ++i) light[static_cast<std::size_t>(3 * width * y + i)] = 2;
    }
  }

  dermis::Frame frame() {
    return {.width = width,
            .height = height,
            .light = {.host = light.data()},
            .depth = {.host = depth.data()},
            .camera = dermis::Camera::perspective(200, 210, 30, 20),
            .mm_per_unit = 0.5,
            .scattered = {.host = scattered.data()}};
  }

  FrameHandle handle() {
    FrameHandle its = made<FrameHandle>([](dermis_frame** f) { return dermis_frame_create(width, height, f); });
    CHECK(dermis_frame_set_image(its.get(), "light", light.data(), nullptr) == DERMIS_DONE);
    CHECK(dermis_frame_set_image(its.get(), "depth", depth.data(), nullptr) == DERMIS_DONE);
    CHECK(dermis_frame_set_output(its.get(), "scattered", scattered.data(), nullptr) == DERMIS_DONE);
    CHECK(dermis_frame_set_perspective(its.get(), 200, 210, 30, 20) == DERMIS_DONE);
    CHECK(dermis_frame_set_mm_per_unit(its.get(), 0.5) == DERMIS_DONE);
    return its;
  }
};

PlanHandle plan_of(const Device& device, const Settings& settings, const FrameHandle& frame) {
  return made<PlanHandle>(
      [&](dermis_plan** plan) { return dermis_plan_create(device.get(), settings.get(), frame.get(), plan); });
}

}  // namespace

TEST_CASE("C and C++ give the same bits") {
  Stripe c;
  Stripe cpp;
  const Device device = open_device();
  const Profile skin = profile("burley:1/0.6/0.4");
  const Settings settings = new_settings();
  CHECK(dermis_settings_set(settings.get(), "rank", "3") == DERMIS_DONE);
  CHECK(dermis_settings_set(settings.get(), "taps", "11") == DERMIS_DONE);
  CHECK(dermis_settings_set(settings.get(), "jitter", "0.25") == DERMIS_DONE);
  CHECK(dermis_settings_set(settings.get(), "seed", "77") == DERMIS_DONE);
  CHECK(dermis_settings_add_material(settings.get(), 5, skin.get(), 0) == DERMIS_DONE);
  const FrameHandle frame = c.handle();
  const PlanHandle plan = plan_of(device, settings, frame);
  const StatsHandle stats = made<StatsHandle>(
      [&](dermis_stats** its) { return dermis_plan_run(plan.get(), frame.get(), nullptr, nullptr, its); });

  const dermis::Options options{.taps = {.rank = 3, .count = 11}, .jitter = 0.25, .seed = 77};
  const dermis::Frame its_frame = cpp.frame();
  const dermis::Plan its_plan(dermis::Device::open(), {{5, dermis::Profile::burley({1, 0.6, 0.4})}},
                              dermis::FrameDescription::of(its_frame), options);
  its_plan.run(its_frame);
  CHECK(c.scattered == cpp.scattered);
  CHECK(c.scattered != c.light);

  double pixels = 0;
  CHECK(dermis_stats_value(stats.get(), "pixels_scattered", &pixels) == DERMIS_DONE);
  CHECK(pixels == Stripe::width * Stripe::height);
  int count = 0;
  while (dermis_stats_name(static_cast<std::size_t>(count)) != nullptr) ++count;
  CHECK(count > 10);
  std::size_t bytes = 0;
  CHECK(dermis_plan_scratch_bytes(plan.get(), 100, 50, &bytes) == DERMIS_DONE);
  CHECK(bytes == its_plan.scratch_bytes(100, 50));
}

TEST_CASE("a progress function in C may stop the run") {
  Stripe stripe;
  const Device device = open_device();
  const Profile skin = profile("burley:0.5/0.3/0.2");
  const Settings settings = new_settings();
  CHECK(dermis_settings_set(settings.get(), "method", "exact") == DERMIS_DONE);
  CHECK(dermis_settings_add_material(settings.get(), 0, skin.get(), 0) == DERMIS_DONE);
  const FrameHandle frame = stripe.handle();
  const PlanHandle plan = plan_of(device, settings, frame);
  const auto stop_at_once = [](double, void* calls) { return ++*static_cast<int*>(calls) < 1 ? 1 : 0; };
  const auto go_on = [](double, void* calls) { return ++*static_cast<int*>(calls); };
  int calls = 0;
  const std::vector<float> before = stripe.scattered;
  CHECK(dermis_plan_run(plan.get(), frame.get(), stop_at_once, &calls, nullptr) == DERMIS_STOPPED);
  CHECK(calls == 1);
  CHECK(stripe.scattered == before);
  CHECK(dermis_plan_run(plan.get(), frame.get(), go_on, &calls, nullptr) == DERMIS_DONE);
  CHECK(calls > 2);
  CHECK(stripe.scattered != before);
}

TEST_CASE("errors in C have the words of those in C++, per thread") {
  const Settings settings = new_settings();
  CHECK(dermis_settings_set(settings.get(), "method", "fast") == DERMIS_USAGE);
  CHECK(std::string(dermis_error_message()) == "method: got fast, want separable, exact, disc");
  CHECK(std::string(dermis_error_argument()) == "method");
  CHECK(std::string(dermis_error_seen()) == "fast");
  CHECK(std::string(dermis_error_wanted()) == "separable, exact, disc");
  std::thread([] { CHECK(std::string(dermis_error_message()).empty()); }).join();

  CHECK(dermis_settings_set(settings.get(), "speed", "1") == DERMIS_USAGE);
  CHECK(std::string(dermis_error_argument()) == "setting");
  CHECK(dermis_settings_set(settings.get(), "seed", "-1") == DERMIS_USAGE);
  CHECK(dermis_settings_set(settings.get(), "jitter", "much") == DERMIS_USAGE);
  CHECK(dermis_settings_set(settings.get(), "curvature", "1") == DERMIS_USAGE);
  CHECK(dermis_settings_set(nullptr, "seed", "1") == DERMIS_USAGE);
  CHECK(std::string(dermis_error_message()) == "settings: got NULL, want a pointer");
  dermis_profile* none = nullptr;
  CHECK(dermis_profile_create("butter", &none) == DERMIS_USAGE);
  CHECK(none == nullptr);
  dermis_device* no_device = nullptr;
  CHECK(dermis_device_open("no such device", 0, &no_device) == DERMIS_DEVICE);

  Stripe stripe;
  const FrameHandle frame = stripe.handle();
  CHECK(dermis_frame_set_image(frame.get(), "scattered", stripe.light.data(), nullptr) == DERMIS_USAGE);
  CHECK(dermis_frame_set_output(frame.get(), "light", stripe.light.data(), nullptr) == DERMIS_USAGE);
  dermis_layout layout{};
  layout.format = 9;
  CHECK(dermis_frame_set_image(frame.get(), "light", stripe.light.data(), &layout) == DERMIS_USAGE);
  dermis_plan* plan = nullptr;
  CHECK(dermis_plan_create(open_device().get(), settings.get(), frame.get(), &plan) == DERMIS_USAGE);
  CHECK(std::string(dermis_error_argument()) == "materials");
  CHECK(plan == nullptr);
}

TEST_CASE("profiles in C are those of C++") {
  const Profile skin = profile("skin");
  const dermis::Profile& expected = dermis::preset("skin").profile;
  double value = 0;
  CHECK(dermis_profile_radial(skin.get(), 1, 0.7, &value) == DERMIS_DONE);
  CHECK(value == expected.radial(1, 0.7));
  CHECK(dermis_profile_cdf(skin.get(), 0, 0.7, &value) == DERMIS_DONE);
  CHECK(value == expected.cdf(0, 0.7));
  CHECK(dermis_profile_radius(skin.get(), 2, 0.5, &value) == DERMIS_DONE);
  CHECK(value == expected.radius(2, 0.5));
  CHECK(dermis_profile_radius(skin.get(), 3, 0.5, &value) == DERMIS_USAGE);
  CHECK(dermis_profile_radius(skin.get(), 2, 1.5, &value) == DERMIS_USAGE);
}

TEST_CASE("every setting has a name and a help, and takes its default as it takes any value") {
  const std::vector<std::pair<const char*, const char*>> values = {{"method", "disc"},
                                                                   {"quality", "draft"},
                                                                   {"quality", "none"},
                                                                   {"tolerance", "0.01"},
                                                                   {"model", "svd"},
                                                                   {"rank", "4"},
                                                                   {"taps", "33"},
                                                                   {"placement", "uniform"},
                                                                   {"disc_samples", "55"},
                                                                   {"disc_accumulate", "2"},
                                                                   {"disc_prefiltered", "on"},
                                                                   {"sheared", "off"},
                                                                   {"jitter", "0.5"},
                                                                   {"seed", "4000000000"},
                                                                   {"lighting", "lit"},
                                                                   {"albedo_mix", "1"},
                                                                   {"curvature", "off"},
                                                                   {"sums_weights", "on"},
                                                                   {"bad_pixels", "zero"},
                                                                   {"skip_uniform_light", "off"},
                                                                   {"device_memory_mb", "100"},
                                                                   {"cache_folder", "/tmp/a folder"}};
  dermis::Options options;
  std::size_t found = 0;
  for (const dermis::Setting& setting : dermis::settings()) {
    CHECK(std::strlen(setting.help) > 5);
    bool is_set = false;
    for (const auto& [name, value] : values) {
      if (std::string(name) != setting.name) continue;
      dermis::set(options, name, value);
      is_set = true;
    }
    CAPTURE(setting.name);
    CHECK(is_set);
    CHECK(dermis_setting_name(found) == std::string(setting.name));
    ++found;
  }
  CHECK(dermis_setting_name(found) == nullptr);
  const dermis::Options expected{
      .method = dermis::Method::disc,
      .tolerance = 0.01,
      .taps = {.model = dermis::Model::svd, .rank = 4, .count = 33, .placement = dermis::Placement::uniform},
      .disc = {.samples = 55, .prefiltered = true, .accumulate = 2},
      .sheared = false,
      .jitter = 0.5,
      .seed = 4000000000,
      .lighting = dermis::Lighting::lit,
      .albedo_mix = 1,
      .curvature = false,
      .sums_weights = true,
      .bad_pixels = dermis::BadPixels::zero,
      .skip_uniform_light = false,
      .device_memory_mb = 100,
      .cache_folder = "/tmp/a folder"};
  CHECK(options == expected);
}
