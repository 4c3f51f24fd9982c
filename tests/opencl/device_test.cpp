// Which device is taken, and what it says when it refuses.
#include "opencl/device.hpp"

#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/program.hpp"
#include "support/catch.hpp"
#include "support/random_frame.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using dermis::Device;
using dermis::DeviceInfo;
using dermis::FrameDescription;
using dermis::Plan;

TEST_CASE("a GPU is taken before a CPU", "[device]") {
  const auto preferred = [](const std::vector<const char*>& types) {
    std::vector<DeviceInfo> devices(types.size());
    for (std::size_t i = 0; i < types.size(); ++i) devices[i].type = types[i];
    return dermis::preferred_device(devices);
  };
  CHECK(preferred({"CPU"}) == 0);
  CHECK(preferred({"CPU", "other"}) == 0);
  CHECK(preferred({"GPU", "GPU"}) == 0);
  CHECK(preferred({"CPU", "GPU", "GPU"}) == 1);
}

TEST_CASE("a program that does not build names the error", "[device]") {
  CHECK_THROWS_WITH(dermis::build_program(Device::open(), {"base/vector.h"}, "-cl-std=CL1.2"),
                    StartsWith("kernels: got ") && Contains("error") && Contains("V: the vector width"));
}

TEST_CASE("a buffer that is too large for the device is named with both sizes", "[device]") {
  const auto method = GENERATE(dermis::Method::separable, dermis::Method::exact, dermis::Method::disc);
  const std::string type = GENERATE("CPU", "GPU");
  const Device device = with_kernel_shape(Device::open(), type == "GPU" ? 1 : 16, type);
  Random random(7201);
  RandomFrame frame(random, {.width = 257, .height = 89, .materials = 1});
  frame.options.method = method;
  const auto run_with = [&](std::uint64_t bytes) {
    const Device limited = with_largest_buffer(device, bytes);
    const auto description = FrameDescription::of(frame.frame());
    Plan(limited, frame.materials, description, frame.options).run(frame.frame());
  };
  CAPTURE(test_seed(), type);
  const std::uint64_t plenty = 1 << 27;
  run_with(plenty);
  // A plan can be made, as the memory depends on the frame: the first buffer that does not fit is named.
  CHECK_THROWS_WITH(run_with(1 << 14),
                    Contains(" buffer: got 0.") && Contains(" MB, want at most 0.0 MB, the largest"));
}

TEST_CASE("textures and lights name a buffer that is too large", "[device]") {
  const Device limited = with_largest_buffer(Device::open(), 1 << 14);
  std::vector<float> light(3UL * 128 * 128, 0.5F);
  std::vector<float> scattered(light.size());
  const dermis::TexturePlan plan(limited, dermis::preset("skin").profile, {});
  CHECK_THROWS_WITH(
      plan.run({.width = 128,
                .height = 128,
                .light = {.host = light.data()},
                .mm_per_texel = 0.1,
                .scattered = {.host = scattered.data()}}),
      (StartsWith("light buffer: ") || StartsWith("scattered buffer: ")) &&  // one may lie where it is read
          Contains(" buffer: got 0.2 MB, want at most 0.0 MB, the largest buffer of " + limited.info().name));
}
