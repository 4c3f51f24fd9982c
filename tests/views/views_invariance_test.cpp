// What must not change a single bit of a frame with views.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "closed_scene.hpp"
#include "dermis/plan.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/guarded_image.hpp"

using dermis::Device;
using dermis::Format;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;
using dermis::View;

namespace {

/// The light after scattering, to compare exactly.
struct Bits {
  std::vector<std::uint32_t> values;
  bool operator==(const Bits&) const = default;
};

Bits bits_of(const std::vector<float>& values) {
  Bits bits{std::vector<std::uint32_t>(values.size())};
  std::memcpy(bits.values.data(), values.data(), sizeof(float) * values.size());
  return bits;
}

std::vector<dermis::Material> materials_of_both() {
  return {{1, Profile::burley({2, 1, 0.7}).projected()}, {2, Profile::burley_cycles({20, 12, 8})}};
}

Bits run(const Plan& plan, Frame frame) {
  std::vector<float> scattered(3 * static_cast<std::size_t>(frame.width) * frame.height);
  frame.scattered.host = scattered.data();
  plan.run(frame);
  return bits_of(scattered);
}

Bits run(const Device& device, const Frame& frame, const Options& options) {
  return run(Plan(device, materials_of_both(), FrameDescription::of(frame), options), frame);
}

/// The images of a view in other memory.
struct MovedView {
  GuardedImage light, albedo, position, normal, material;
  View view;

  MovedView(const View& from, const Shot& shot, Format format, Format ids, Random* gaps)
      : light(from.width, from.height, 3, format, gaps),
        albedo(from.width, from.height, 3, format, gaps),
        position(from.width, from.height, 3, format, gaps),
        normal(from.width, from.height, 3, format, gaps),
        material(from.width, from.height, 1, ids, gaps),
        view(from) {
    const auto copy = [&](const std::vector<float>& values, GuardedImage& to) {
      for (int y = 0; y < from.height; ++y) {
        for (int x = 0; x < from.width; ++x) {
          for (int c = 0; c < to.channels(); ++c)
            to.set(x, y, c, values[(static_cast<std::size_t>(y) * from.width + x) * to.channels() + c]);
        }
      }
      return to.image();
    };
    view.light = copy(shot.light, light);
    view.albedo = copy(shot.albedo, albedo);
    view.position = copy(shot.position, position);
    view.normal = copy(shot.normal, normal);
    view.material = copy(shot.material, material);
  }
};

}  // namespace

TEST_CASE("a frame with views does not depend on how it is computed", "[views]") {
  const Method method = GENERATE(Method::separable, Method::exact, Method::disc);
  Random random(200);
  const ClosedScene scene = closed_scene(random, Subject::two, Place::corners);
  const std::vector<View> views = scene.views();
  Frame frame = scene.frame();
  frame.views = views;
  const Options options{.method = method};
  CAPTURE(test_seed(), static_cast<int>(method));
  const Device device = Device::open();
  const Bits expected = run(device, frame, options);
  const Frame alone = scene.frame();
  CHECK(run(device, alone, options) != expected);

  CHECK(run(Device::open({}, 1), frame, options) == expected);
  CHECK(run(Device::open({}, 2), frame, options) == expected);
  if (method != Method::disc) {  // whose kernels have one width
    for (const int vector_width : {1, 4}) {
      CAPTURE(vector_width);
      CHECK(run(with_kernel_shape(device, vector_width, "CPU"), frame, options) == expected);
    }
  }
  // What the method itself gives by pixels is tested elsewhere; hidden light must not differ.
  const Device by_pixels = with_kernel_shape(device, 1, "GPU");
  if (run(by_pixels, alone, options) == run(device, alone, options)) CHECK(run(by_pixels, frame, options) == expected);
}

TEST_CASE("a frame without views is as if there were none", "[views]") {
  const Method method = GENERATE(Method::separable, Method::exact, Method::disc);
  Random random(210);
  const ClosedScene scene = closed_scene(random, Subject::two, Place::behind);
  const Frame frame = scene.frame();
  const Options options{.method = method};
  FrameDescription with_views = FrameDescription::of(frame);
  with_views.views = true;
  const Device device = Device::open();
  CAPTURE(test_seed(), static_cast<int>(method));
  const Bits expected = run(device, frame, options);
  CHECK(run(Plan(device, materials_of_both(), with_views, options), frame) == expected);
  // Nor is a view in which nothing has a material.
  ClosedScene empty = scene;
  for (Shot& shot : empty.others) std::fill(shot.material.begin(), shot.material.end(), 7.0F);
  const std::vector<View> views = empty.views();
  Frame with_empty = frame;
  with_empty.views = views;
  CHECK(run(device, with_empty, options) == expected);
}

TEST_CASE("a material without hidden surface keeps its bits", "[views]") {
  const Method method = GENERATE(Method::separable, Method::exact, Method::disc);
  Random random(220);
  ClosedScene scene = closed_scene(random, Subject::two, Place::behind);
  const Options options{.method = method};
  const Device device = Device::open();
  const Bits without = run(device, scene.frame(), options);
  for (Shot& shot : scene.others) std::replace(shot.material.begin(), shot.material.end(), 1.0F, 0.0F);
  const std::vector<View> views = scene.views();
  Frame frame = scene.frame();
  frame.views = views;
  const Bits with = run(device, frame, options);
  CAPTURE(test_seed(), static_cast<int>(method));
  std::size_t changed = 0;
  std::size_t changed_of_1 = 0;
  for (std::size_t i = 0; i < with.values.size(); ++i) {
    if (with.values[i] == without.values[i]) continue;
    ++changed;
    if (scene.front.material[i / 3] == 1) ++changed_of_1;
  }
  CHECK(changed > 100);
  CHECK(changed_of_1 == 0);
}

TEST_CASE("the images of views may lie anywhere, in any format", "[views]") {
  Random random(230);
  const ClosedScene scene = closed_scene(random, Subject::two, Place::corners);
  const std::vector<View> views = scene.views();
  Frame frame = scene.frame();
  const Options options{.method = Method::exact};
  const Device device = Device::open();
  CAPTURE(test_seed());
  const auto with_views = [&](const Device& its_device, std::span<const View> its_views) {
    frame.views = its_views;
    return run(its_device, frame, options);
  };
  const auto moved = [&](Format format, Format ids, Random* gaps) {
    std::vector<MovedView> all;
    for (std::size_t i = 0; i < views.size(); ++i) all.emplace_back(views[i], scene.others[i], format, ids, gaps);
    return all;
  };
  // Where the images of a moved view lie is only known once it has its place.
  const auto images_of = [](const std::vector<MovedView>& all) {
    std::vector<View> result;
    for (const MovedView& its : all) {
      result.push_back(its.view);
      result.back().light = its.light.image();
      result.back().albedo = its.albedo.image();
      result.back().position = its.position.image();
      result.back().normal = its.normal.image();
      result.back().material = its.material.image();
    }
    return result;
  };

  const Bits expected = with_views(device, views);
  const auto strided = moved(Format::f32, Format::u16, &random);
  CHECK(with_views(device, images_of(strided)) == expected);

  // Halves are those floats.
  const auto halves = moved(Format::f16, Format::f16, nullptr);
  ClosedScene rounded = scene;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto round = [&](std::vector<float>& values) {
      for (float& value : values)
        value = static_cast<float>(dermis::bench::value_of_half(dermis::bench::half_of(value)));
    };
    for (auto* values :
         {&rounded.others[i].light, &rounded.others[i].albedo, &rounded.others[i].position, &rounded.others[i].normal})
      round(*values);
  }
  const Bits of_halves = with_views(device, images_of(halves));
  CHECK(of_halves != expected);
  CHECK(of_halves == with_views(device, rounded.views()));

  const cl::Context context(device.context(), true);
  std::vector<cl::Buffer> buffers;
  std::vector<View> in_buffers = images_of(strided);
  for (std::size_t i = 0; i < in_buffers.size(); ++i) {
    const auto move_in = [&](const GuardedImage& image, dermis::Image& view) {
      buffers.emplace_back(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, image.memory().size(),
                           const_cast<std::byte*>(image.memory().data()));
      view.host = nullptr;
      view.buffer = buffers.back()();
    };
    move_in(strided[i].light, in_buffers[i].light);
    move_in(strided[i].albedo, in_buffers[i].albedo);
    move_in(strided[i].position, in_buffers[i].position);
    move_in(strided[i].normal, in_buffers[i].normal);
    move_in(strided[i].material, in_buffers[i].material);
  }
  CHECK(with_views(Device::adopt(context(), device.id()), in_buffers) == expected);
}

TEST_CASE("pixels of a view that are not finite are background", "[views]") {
  Random random(240);
  const ClosedScene scene = closed_scene(random, Subject::sphere, Place::behind);
  const Options options{.method = Method::exact};
  const Device device = Device::open();
  const float bad = random.coin() ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
  std::vector<std::size_t> places;
  for (int i = 0; i < 40; ++i)
    places.push_back(static_cast<std::size_t>(random.integer(0, static_cast<int>(scene.others[0].pixels()) - 1)));
  const auto spoiled = [&](const auto& spoil) {
    ClosedScene its = scene;
    for (const std::size_t place : places) spoil(its.others[0], place);
    const std::vector<View> views = its.views();
    Frame frame = its.frame();
    frame.views = views;
    return run(device, frame, options);
  };
  CAPTURE(test_seed(), bad);
  const Bits expected = spoiled([](Shot& shot, std::size_t i) { shot.material[i] = 0; });
  CHECK(expected != spoiled([](Shot&, std::size_t) {}));
  CHECK(spoiled([&](Shot& shot, std::size_t i) { shot.position[3 * i + 1] = bad; }) == expected);
  CHECK(spoiled([&](Shot& shot, std::size_t i) { shot.normal[3 * i + 2] = bad; }) == expected);
  CHECK(spoiled([&](Shot& shot, std::size_t i) { std::fill_n(&shot.normal[3 * i], 3, 0.0F); }) == expected);
  // Such a pixel still shows its neighbours how far the surface goes on.
  const Bits without_light = spoiled([&](Shot& shot, std::size_t i) { shot.light[3 * i] = bad; });
  CHECK(without_light != spoiled([](Shot&, std::size_t) {}));
  CHECK(spoiled([&](Shot& shot, std::size_t i) { shot.albedo[3 * i + 1] = bad; }) == without_light);
  for (const std::uint32_t bits : without_light.values) REQUIRE((~bits & 0x7f800000U) != 0);  // finite
}

TEST_CASE("a sequence in which frames with views stand between others", "[views]") {
  Random random(250);
  const ClosedScene scene = closed_scene(random, Subject::flat, Place::behind);
  const std::vector<View> views = scene.views();
  const Frame alone = scene.frame();
  Frame with_views = alone;
  with_views.views = views;
  const Plan plan(Device::open(), materials_of_both(), FrameDescription::of(with_views));
  const Bits expected = run(plan, alone);
  const Bits expected_with = run(plan, with_views);
  CHECK(expected != expected_with);
  dermis::Reuse reuse;
  const auto run_on = [&](Frame frame) {
    std::vector<float> scattered(expected.values.size());
    frame.scattered.host = scattered.data();
    plan.run(frame, reuse);
    return bits_of(scattered);
  };
  CAPTURE(test_seed());
  CHECK(run_on(alone) == expected);
  CHECK(run_on(with_views) == expected_with);
  CHECK(run_on(alone) == expected);
}
