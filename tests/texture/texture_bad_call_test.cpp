// Each bad call about textures fails with the right kind and message.
#include <cmath>

#include "dermis/error.hpp"
#include "dermis/texture.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"

using dermis::Device;
using dermis::ErrorCode;
using dermis::Profile;
using dermis::TextureDescription;
using dermis::TextureFrame;
using dermis::TextureOptions;
using dermis::TexturePlan;

namespace {

template <class Call>
void check_error(const Call& call, ErrorCode code, const std::string& message) {
  const Failure failure = failure_of(call);
  CHECK_THAT(failure.message, Catch::StartsWith(message));
  CHECK(failure.code == code);
}

const Profile skin = dermis::preset("skin").profile;

}  // namespace

TEST_CASE("plans for textures that cannot be", "[texture][bad]") {
  const Device device = Device::open();
  const auto plan = [&](const Profile& profile, const TextureOptions& options) {
    return [&device, profile, options] { TexturePlan(device, profile, {}, options); };
  };
  check_error(plan(skin, {.albedo_mix = NAN}), ErrorCode::usage, "albedo_mix: got nan, want 0..1");
  check_error(plan(skin, {.albedo_mix = 0.5}), ErrorCode::role_missing,
              "albedo: got no image, want an albedo image for albedo_mix above 0");
  check_error(plan(Profile::burley_cycles({1, 1, 1}), {}), ErrorCode::usage,
              "profile: got one whose width follows the albedo");
  // Light that comes out on a ring has a spectrum that swings, and exponentials do not.
  std::vector<dermis::TableRow> ring;
  for (const double r : {4.9, 5.0, 5.1}) ring.push_back({r, r == 5.0 ? dermis::Rgb{1, 1, 1} : dermis::Rgb{0, 0, 0}});
  ring.insert(ring.begin(), {4.8, {0, 0, 0}});
  check_error(plan(Profile::tabulated(ring), {.method = dermis::TextureMethod::recursive}), ErrorCode::usage,
              "profile: got one that recursion is off by ");
}

TEST_CASE("textures that cannot be", "[texture][bad]") {
  const TexturePlan plan(Device::open(), skin, {});
  std::vector<float> light(3 * 12, 0.5F);
  std::vector<float> out(3 * 12 + 3, 7);
  const TextureFrame good{
      .width = 4, .height = 3, .light = {.host = light.data()}, .mm_per_texel = 1, .scattered = {.host = out.data()}};
  const auto run = [&](const auto& change) {
    TextureFrame frame = good;
    change(frame);
    return [&plan, frame] { plan.run(frame); };
  };
  check_error(run([](TextureFrame& f) { f.width = 0; }), ErrorCode::usage, "texture size: got 0x3, want 1..65536");
  check_error(run([](TextureFrame& f) { f.light = {}; }), ErrorCode::role_missing, "light: got no image");
  check_error(run([](TextureFrame& f) { f.scattered = {}; }), ErrorCode::usage, "outputs: got none");
  check_error(run([](TextureFrame& f) { f.mm_per_texel = -1; }), ErrorCode::usage, "mm_per_texel: got -1.000000");
  check_error(run([](TextureFrame& f) { f.mask = f.light; }), ErrorCode::usage, "mask: got an image, want none");
  check_error(run([](TextureFrame& f) { f.result = f.scattered; }), ErrorCode::role_missing, "albedo: got no image");
  check_error(run([&](TextureFrame& f) {
                f.light.host = out.data();
                f.scattered.host = out.data() + 3;
              }),
              ErrorCode::usage, "scattered: got memory of light");
  CHECK(out == std::vector<float>(out.size(), 7));
  const TexturePlan stretched(Device::open(), skin, {.stretch = true});
  TextureFrame half = good;
  half.stretch_u = {.host = light.data()};
  check_error([&] { stretched.run(half); }, ErrorCode::role_missing, "stretch_v: got no image");
  check_error([&] { dermis::stretch_of_positions(4, 3, {}, {}, 1); }, ErrorCode::usage, "position: got no image");
  check_error([&] { dermis::stretch_of_positions(4, 3, good.light, {}, 0); }, ErrorCode::usage,
              "mm_per_unit: got 0.000000");
  CHECK(out == std::vector<float>(out.size(), 7));
}
