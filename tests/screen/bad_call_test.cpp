// Each bad call of the library fails with the right kind and message.
#include <cmath>

#include "dermis/dermis.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Error;
using dermis::ErrorCode;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;

namespace {

template <class Call>
void check_error(const Call& call, ErrorCode code, const std::string& message) {
  const Failure failure = failure_of(call);
  CHECK(failure.message == message);
  CHECK(failure.code == code);
}

const std::vector<dermis::Material> skin = {{0, dermis::preset("skin").profile}};

}  // namespace

TEST_CASE("devices that are not there", "[bad]") {
  CHECK_THROWS_WITH(Device::open("no-such-device"),
                    Catch::StartsWith("device: got \"no-such-device\", want one of 0: "));
  CHECK_THROWS_AS(Device::open("12345"), Error);
  CHECK_THROWS_WITH(Device::open({}, -1), Catch::StartsWith("threads: got -1, want 1.."));
  CHECK_THROWS_AS(Device::open({}, 100000), Error);
  check_error([] { Device::adopt(nullptr, nullptr); }, ErrorCode::usage, "context: got nullptr, want an OpenCL handle");
}

TEST_CASE("plans that cannot be", "[bad]") {
  const Device device = Device::open();
  const auto plan = [&](const Options& options, FrameDescription frames = {},
                        std::vector<dermis::Material> materials = skin) {
    return [=] { Plan(device, materials, frames, options); };
  };
  check_error(plan({.taps = {.count = 4}}), ErrorCode::usage, "taps: got 4, want an odd number, 3..2047");
  check_error(plan({.jitter = 1.5}), ErrorCode::usage, "jitter: got 1.500000, want 0..1");
  check_error(plan({.jitter = NAN}), ErrorCode::usage, "jitter: got nan, want 0..1");
  check_error(plan({.disc = {.samples = 1025}}), ErrorCode::usage, "disc samples: got 1025, want 0..1024");
  check_error(plan({.disc = {.samples = -1}}), ErrorCode::usage, "disc samples: got -1, want 0..1024");
  check_error(plan({.disc = {.accumulate = 0}}), ErrorCode::usage, "disc accumulate: got 0, want 1..65536");
  check_error(plan({.albedo_mix = -0.5}), ErrorCode::usage, "albedo_mix: got -0.500000, want 0..1");
  check_error(plan({.tile_width = 20}), ErrorCode::usage, "tile_width: got 20, want a multiple of 16 up to 65536");
  check_error(plan({.tile_height = -1}), ErrorCode::usage, "tile_height: got -1, want 0..65536");
  check_error(plan({.device_memory_mb = -1}), ErrorCode::usage, "device_memory_mb: got -1, want 0..1000000");
  check_error(plan({}, {}, {}), ErrorCode::usage,
              "materials: got 0, want exactly 1, as the frames have no material ids");
  check_error(plan({}, {.material = true}, {{1, skin[0].profile}, {1, skin[0].profile}}), ErrorCode::usage,
              "material id: got 1, want different ids in 0..65535");
  check_error(plan({}, {.material = true}, {{-1, skin[0].profile}}), ErrorCode::usage,
              "material id: got -1, want different ids in 0..65535");
  check_error(plan({.albedo_mix = 0.5}), ErrorCode::role_missing,
              "albedo: got no image, want an albedo image for albedo_mix above 0");
  check_error(plan({}, {}, {{0, Profile::burley_cycles({1, 1, 1})}}), ErrorCode::role_missing,
              "albedo: got no image, want an albedo image, which a profile takes its width from");
}

TEST_CASE("frames that do not fit", "[bad]") {
  const Device device = Device::open();
  std::vector<float> pixels(64 * 64 * 3, 1.0F), output(pixels.size());
  Frame good{.width = 8, .height = 8, .light = {.host = pixels.data()}, .camera = Camera::orthographic(4, 4)};
  good.scattered.host = output.data();
  const Plan plan(device, skin, FrameDescription::of(good), {});
  CHECK_NOTHROW(plan.run(good));
  const auto with = [&](auto change) {
    return [&plan, good, change] {
      Frame frame = good;
      change(frame);
      plan.run(frame);
    };
  };
  check_error(with([](Frame& f) { f.width = 0; }), ErrorCode::usage,
              "frame size: got 0x8, want 1..65536 pixels on each side");
  check_error(with([](Frame& f) { f.height = 1 << 20; }), ErrorCode::usage,
              "frame size: got 8x1048576, want 1..65536 pixels on each side");
  check_error(with([](Frame& f) { f.light.host = nullptr; }), ErrorCode::role_missing,
              "light: got no image, want an image, as the plan was made for one");
  check_error(with([](Frame& f) { f.depth = f.light; }), ErrorCode::usage,
              "depth: got an image, want none, as the plan was made without");
  check_error(with([](Frame& f) { f.scattered.host = nullptr; }), ErrorCode::usage,
              "outputs: got none, want a scattered or a result image");
  check_error(with([](Frame& f) { f.light.layout.format = dermis::Format::u8; }), ErrorCode::usage,
              "light format: got an integer format, want f16 or f32");
  check_error(with([](Frame& f) { f.light.layout.row_stride = 97; }), ErrorCode::usage,
              "light layout: got 97 bytes, want pointer, offset and strides in multiples of the 4 bytes of a value");
  check_error(with([](Frame& f) { f.mm_per_unit = NAN; }), ErrorCode::usage, "mm_per_unit: got nan, want 1e-18..1e18");
  check_error(with([](Frame& f) { f.camera.scale_x = NAN; }), ErrorCode::usage,
              "camera scale_x: got nan, want 1e-18..1e18");
  check_error(with([](Frame& f) { f.camera.scale_y = -3; }), ErrorCode::usage,
              "camera scale_y: got -3.000000, want 1e-18..1e18");
  check_error(with([](Frame& f) { f.camera.center_x = INFINITY; }), ErrorCode::usage,
              "camera center: got inf, want a finite number of pixels");
  check_error(with([](Frame& f) { f.camera = Camera::perspective(100, 100, 4, 4); }), ErrorCode::role_missing,
              "depth: got no image, want a depth image, or an orthographic camera");
  check_error(with([&](Frame& f) { f.result.host = f.scattered.host; }), ErrorCode::role_missing,
              "beauty: got no image, want an image, as the plan was made for one");
  check_error([&] { plan.enqueue(good, nullptr); }, ErrorCode::usage,
              "queue: got nullptr, want an OpenCL command queue");
}
