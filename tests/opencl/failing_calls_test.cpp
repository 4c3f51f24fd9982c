// Every call of OpenCL fails once: the error is one of the device, nothing is lost, and what was made goes on working.
#include "support/failing_calls.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::Device;
using dermis::ErrorCode;

namespace {

/// Taps are kept for all plans of this process, so that plans are quick to make.
const std::string& taps_folder() {
  static const TemporaryFolder folder;
  static const std::string name = folder / "taps";
  return name;
}

/// Images of one frame: light, a plane that it falls on at z = 0, and one a millimetre behind that faces away.
struct Scene {
  int width, height;
  std::size_t values = 3UL * width * height;
  std::vector<float> light, albedo, depth, position, behind, normal, map;
  std::vector<dermis::Light> lights;
  std::vector<dermis::View> views;

  Scene(int its_width, int its_height)
      : width(its_width), height(its_height), albedo(values, 0.5F), depth(values / 3, 1.0F), map(values / 3, 3.0F) {
    Random random(7700);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::array at = {static_cast<float>(x) / 6, static_cast<float>(y) / 6};
        for (int c = 0; c < 3; ++c) light.push_back(static_cast<float>(random.uniform(0, 4)));
        position.insert(position.end(), {at[0], at[1], 0});
        behind.insert(behind.end(), {at[0], at[1], 2});
        normal.insert(normal.end(), {0, 0, 1});
      }
    }
    lights.push_back({.direction = {0.2, 0.1, -1}, .position = {3, 2, 3}, .colour = {1, 0.8, 0.5}});
    lights.push_back({.kind = dermis::Light::Kind::spot, .position = {3, 2, 3}, .colour = {5, 4, 3}});
    lights.back().map = {.depth = {.host = map.data()},
                         .width = width,
                         .height = height,
                         .view_projection = {1, 0, 0, -3, 0, 1, 0, -2, 0, 0, 1, 0, 0, 0, -1, 3}};
    views.push_back({.width = width,
                     .height = height,
                     .light = {.host = light.data()},
                     .position = {.host = behind.data()},
                     .normal = {.host = normal.data()}});
  }
};

using Run = std::function<std::vector<float>()>;

/// A plan on a device, and a run of it that returns what it writes.
struct Work {
  std::string name;
  std::function<Run(const Device&, const std::shared_ptr<const Scene>&)> make;
};

const dermis::Profile& skin() { return dermis::preset("skin").profile; }

Work screen(const std::string& name, dermis::Options options, bool has_views = false, bool reuses = false) {
  options.cache_folder = taps_folder();
  return {name, [=](const Device& device, const std::shared_ptr<const Scene>& scene) -> Run {
            const auto plan = std::make_shared<const dermis::Plan>(
                device, std::vector<dermis::Material>{{.profile = skin()}},
                dermis::FrameDescription{.depth = true, .views = has_views}, options);
            const auto reuse = std::make_shared<dermis::Reuse>();
            return [=] {
              std::vector<float> out(scene->values);
              dermis::Frame frame{.width = scene->width,
                                  .height = scene->height,
                                  .light = {.host = scene->light.data()},
                                  .depth = {.host = scene->depth.data()},
                                  .camera = dermis::Camera::orthographic(6, 6),
                                  .scattered = {.host = out.data()}};
              if (has_views) frame.views = scene->views;
              reuses ? plan->run(frame, *reuse) : plan->run(frame);
              return out;
            };
          }};
}

Work texture(const std::string& name, dermis::TextureMethod method) {
  return {name, [=](const Device& device, const std::shared_ptr<const Scene>& scene) -> Run {
            const auto plan = std::make_shared<const dermis::TexturePlan>(device, skin(), dermis::TextureDescription{},
                                                                          dermis::TextureOptions{.method = method});
            return [=] {
              std::vector<float> out(scene->values);
              plan->run({.width = scene->width,
                         .height = scene->height,
                         .light = {.host = scene->light.data()},
                         .mm_per_texel = 0.3,
                         .scattered = {.host = out.data()}});
              return out;
            };
          }};
}

Work shading() {
  return {"light", [](const Device& device, const std::shared_ptr<const Scene>& scene) -> Run {
            const auto shading = std::make_shared<const dermis::Shading>(device);
            return [=] {
              std::vector<float> out(scene->values);
              dermis::ShadingFrame frame{.width = scene->width,
                                         .height = scene->height,
                                         .position = {.host = scene->position.data()},
                                         .normal = {.host = scene->normal.data()},
                                         .albedo = {.host = scene->albedo.data()},
                                         .lights = scene->lights};
              frame.viewer.place = {0, 0, 5};
              frame.beauty.host = out.data();
              shading->run(frame);
              return out;
            };
          }};
}

Work translucency() {
  return {"translucency", [](const Device& device, const std::shared_ptr<const Scene>& scene) -> Run {
            const auto translucency = std::make_shared<const dermis::Translucency>(
                device, std::vector<dermis::Material>{{.profile = skin()}}, dermis::TranslucencyDescription{});
            return [=] {
              std::vector<float> out(scene->values);
              translucency->run({.width = scene->width,
                                 .height = scene->height,
                                 .light = {.host = scene->light.data()},
                                 .position = {.host = scene->position.data()},
                                 .normal = {.host = scene->normal.data()},
                                 .lights = scene->lights,
                                 .lit = {.host = out.data()}});
              return out;
            };
          }};
}

std::vector<Work> all_work() {
  const dermis::TapsDesign few{.rank = 2, .count = 9};
  return {screen("separable", {.taps = few}),
          screen("reuse", {.taps = few}, false, true),
          screen("views", {.taps = few}, true),
          screen("exact", {.method = dermis::Method::exact}),
          screen("disc", {.method = dermis::Method::disc, .disc = {.prefiltered = true}}),
          texture("texture", dermis::TextureMethod::gaussians),
          texture("recursive texture", dermis::TextureMethod::recursive),
          shading(),
          translucency()};
}

/// Which calls fail: every `step`-th from a random one on, of the first `most`; and all after it, or that one only.
struct Sweep {
  int step = 1;
  bool all_after = false;
  int most = std::numeric_limits<int>::max();
};

/// A call fails in some work: the error is one of the device, in one line, or it does not matter. What was held before
/// is held after.
void check_failure(const std::string& name, int number, bool all_after, const Run& run,
                   const std::vector<float>& expected) {
  std::vector<float> result;
  fail_call(number, all_after);
  const Failure failure = failure_of([&] { result = run(); });
  const std::string call = failed_call();
  fail_call(0);
  CAPTURE(test_seed(), name, number, call, failure.message);
  if (failure.code) {
    CHECK(*failure.code == ErrorCode::device);
    CHECK(failure.message.find('\n') == std::string::npos);
    CHECK(!failure.says("got ,"));
  } else {
    CHECK(result == expected);
  }
}

/// Calls of a run fail; the next run is right, and holds what the one before held. Returns how many have failed.
int fail_runs(const Work& work, const Device& device, const std::shared_ptr<const Scene>& scene, const Sweep& sweep) {
  const Run run = work.make(device, scene);
  const std::vector<float> expected = run();
  CHECK(expected != std::vector<float>(expected.size()));
  run();
  const long held = objects_held();
  fail_call(0);
  run();
  const int calls = std::min(calls_made(), sweep.most);
  int failures = 0;
  for (int number = Random(7701).integer(1, sweep.step); number <= calls; number += sweep.step) {
    check_failure(work.name, number, sweep.all_after, run, expected);
    CAPTURE(test_seed(), work.name, number);
    CHECK(run() == expected);
    CHECK(objects_held() == held);
    ++failures;
  }
  return failures;
}

/// Calls fail while a device is opened and a plan is made and run.
int fail_plans(const Work& work, const std::shared_ptr<const Scene>& scene, const Sweep& sweep) {
  const auto whole = [&] { return work.make(Device::open(), scene)(); };
  fail_call(0);
  const std::vector<float> expected = whole();
  const int calls = std::min(calls_made(), sweep.most);
  const long held = objects_held();
  int failures = 0;
  for (int number = Random(7702).integer(1, sweep.step); number <= calls; number += sweep.step) {
    check_failure(work.name, number, sweep.all_after, whole, expected);
    CAPTURE(test_seed(), work.name, number);
    CHECK(objects_held() == held);
    ++failures;
  }
  return failures;
}

int fail_all_runs(const Device& device, const std::shared_ptr<const Scene>& scene, const Sweep& sweep) {
  int failures = 0;
  for (const Work& work : all_work()) failures += fail_runs(work, device, scene, sweep);
  return failures;
}

std::shared_ptr<const Scene> small_scene() { return std::make_shared<const Scene>(40, 24); }
std::shared_ptr<const Scene> large_scene() { return std::make_shared<const Scene>(400, 240); }

}  // namespace

TEST_CASE("a call of a run that fails is an error, and the next run is right", "[failing]") {
  install_failing_calls();
  const long before = objects_held();
  fail_all_runs(Device::open(), small_scene(), {.step = 9});
  CHECK(objects_held() == before);
}

TEST_CASE("a call that fails while a plan is made is an error", "[failing]") {
  install_failing_calls();
  for (const Work& work : all_work()) fail_plans(work, small_scene(), {.step = 149});
}

TEST_CASE("every call fails once", "[.every-call]") {
  install_failing_calls();
  const long before = objects_held();
  int failures = 0;
  {
    const Device device = Device::open();
    failures += fail_all_runs(device, small_scene(), {});
    failures += fail_all_runs(device, large_scene(), {.step = 5});  // while kernels are at work
    failures += fail_all_runs(with_kernel_shape(device, 1, "GPU"), small_scene(), {.step = 2});
    failures += fail_all_runs(device, small_scene(), {.step = 41, .all_after = true});
  }
  for (const Work& work : all_work()) failures += fail_plans(work, small_scene(), {.step = 5});
  CHECK(objects_held() == before);
  WARN(failures << " calls have failed");
}
