// Views that do not fit are refused in one line.
#include <cmath>

#include "closed_scene.hpp"
#include "dermis/plan.hpp"
#include "opencl/device.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"

using dermis::Device;
using dermis::ErrorCode;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Plan;
using dermis::View;

namespace {

const std::vector<dermis::Material> materials = {{1, dermis::Profile::burley({2, 1, 1})},
                                                 {2, dermis::Profile::burley({2, 1, 1})}};

/// A good call, whose second view is spoiled.
struct GoodCall {
  Random random{300};
  ClosedScene scene = closed_scene(random, Subject::sphere, Place::corners);
  std::vector<View> views = scene.views();
  std::vector<float> scattered = std::vector<float>(3 * scene.front.pixels());
  Frame frame = scene.frame();
  Plan plan = make_plan();

  Plan make_plan() {
    frame.views = views;
    frame.scattered.host = scattered.data();
    return Plan(Device::open(), materials, FrameDescription::of(frame));
  }

  template <class Spoil>
  Failure failure(const Spoil& spoil) {
    std::vector<View> spoiled = views;
    spoil(spoiled[1]);
    Frame bad = frame;
    bad.views = spoiled;
    return failure_of([&] { plan.run(bad); });
  }
};

void check(const Failure& failure, ErrorCode code, const std::string& message) {
  CHECK(failure.message == message);
  CHECK(failure.code == code);
}

}  // namespace

TEST_CASE("views that lack something are refused", "[views][bad]") {
  GoodCall call;
  CHECK(call.failure([](View&) {}).message.empty());
  for (const auto& [image, name] : {std::pair{&View::light, "light"},
                                    {&View::albedo, "albedo"},
                                    {&View::position, "position"},
                                    {&View::normal, "normal"},
                                    {&View::material, "material"}}) {
    const auto member = image;
    check(call.failure([&](View& view) { view.*member = {}; }), ErrorCode::role_missing,
          std::string("view 2 ") + name + ": got no image, want an image");
  }
  check(call.failure([](View& view) { view.width = 0; }), ErrorCode::usage,
        "view 2 size: got 0x" + std::to_string(call.views[1].height) + ", want 1..65536 pixels on each side");
  const Failure format = call.failure([](View& view) { view.position.layout.format = dermis::Format::u8; });
  CHECK(format.code == ErrorCode::usage);
  CHECK(format.says("view 2 position"));
}

TEST_CASE("views that are moved by what is no motion are refused", "[views][bad]") {
  GoodCall call;
  const std::string message =
      "view 2 to_camera: got a matrix that scales, mirrors or is not finite, want a rotation and a translation";
  check(call.failure([](View& view) {
    for (double& value : view.to_camera) value *= 1.01;
  }),
        ErrorCode::usage, message);
  check(call.failure([](View& view) {
    for (int k = 0; k < 3; ++k) view.to_camera[k] *= -1;
  }),
        ErrorCode::usage, message);
  for (const int i : {0, 5, 10, 3, 11})
    check(call.failure([&](View& view) { view.to_camera[i] = NAN; }), ErrorCode::usage, message);
  check(call.failure([](View& view) { view.to_camera[7] = INFINITY; }), ErrorCode::usage, message);
  check(call.failure([](View& view) { view.to_camera = {}; }), ErrorCode::usage, message);
}

TEST_CASE("views of something else are refused", "[views][bad]") {
  GoodCall call;
  const auto check_contradicts = [&](const Failure& failure) {
    CAPTURE(failure.message);
    CHECK(failure.code == ErrorCode::input_unsupported);
    CHECK(failure.message.starts_with("view 2: got "));
    CHECK(failure.message.ends_with(
        " % of its surface in front of what the camera sees, want the surfaces of the same frame, in its scene units"));
  };
  // The sphere has a radius of 10 and lies 60 before the camera.
  check_contradicts(call.failure([](View& view) { view.to_camera[11] -= 8; }));
  ClosedScene smaller = call.scene;
  for (float& value : smaller.others[1].position) value *= 0.01F;
  check_contradicts(call.failure([&](View& view) {
    view = smaller.views()[1];
    view.to_camera[11] -= 25;
  }));
}

TEST_CASE("plans that cannot take views refuse them", "[views][bad]") {
  GoodCall call;
  Frame alone = call.frame;
  alone.views = {};
  const Plan without(Device::open(), materials, FrameDescription::of(alone));
  check(failure_of([&] { without.run(call.frame); }), ErrorCode::usage,
        "views: got 2 views, want none, as the plan was made without");

  FrameDescription flat = FrameDescription::of(call.frame);
  flat.depth = false;
  check(failure_of([&] { Plan(Device::open(), materials, flat); }), ErrorCode::role_missing,
        "depth: got no image, want a depth image, for frames with views");

  const Device device = Device::open();
  const cl::Context context(device.context(), true);
  const cl::CommandQueue queue(context, cl::Device(device.id(), true));
  const cl::Buffer buffer(context, CL_MEM_READ_WRITE, sizeof(float) * call.scattered.size());
  Frame in_buffers = call.frame;
  for (dermis::Image* image : {&in_buffers.light, &in_buffers.albedo, &in_buffers.depth, &in_buffers.material})
    *image = {.buffer = buffer()};
  in_buffers.scattered = {.buffer = buffer()};
  const Plan plan(Device::adopt(context(), device.id()), materials, FrameDescription::of(in_buffers));
  check(failure_of([&] { plan.enqueue(in_buffers, queue(), {}); }), ErrorCode::usage,
        "views: got 2 views, want none, as enqueue cannot wait for them");
}
