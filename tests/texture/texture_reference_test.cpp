// The kernels of texture space equal the oracle within the bound that it derives from float rounding.
#include "dermis/oracle/texture.hpp"
#include "inputs/half.hpp"
#include "support/catch.hpp"
#include "texture/random_texture.hpp"

using dermis::Device;
using dermis::Profile;
using dermis::TextureDescription;
using dermis::TextureFrame;
using dermis::TextureMethod;
using dermis::TexturePlan;
namespace oracle = dermis::oracle;

namespace {

oracle::TextureReference expected_of(const TextureFrame& frame, const Profile& profile,
                                     const dermis::TextureOptions& options) {
  return options.method == TextureMethod::recursive
             ? oracle::recursion(frame, dermis::make_recursion(profile), options.albedo_mix)
             : oracle::gaussian_chain(frame, dermis::make_gaussian_chain(profile), options.albedo_mix);
}

struct Tally {
  double squared_error = 0, squared = 0;  ///< of outputs of float32
  long values = 0, changed = 0, empty = 0;
};

void compare(const GuardedImage& output, const oracle::Picture& expected, const oracle::Picture& bound, Tally& tally) {
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double value = expected(x, y, c);
        if (std::isnan(value)) {
          REQUIRE(std::isnan(output.get(x, y, c)));
          continue;
        }
        const bool half = output.layout().format == dermis::Format::f16;
        const double error = std::abs(output.get(x, y, c) - value);
        const double allowed = bound(x, y, c) + (half ? dermis::bench::half_last_place(value) / 2 : 0);
        CAPTURE(x, y, c, value, output.get(x, y, c), error, allowed);
        if (!(error <= allowed)) REQUIRE(error <= allowed);
        ++tally.values;
        if (!half) {
          tally.squared_error += error * error;
          tally.squared += value * value;
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("textures equal the oracle within float rounding", "[texture]") {
  const TextureMethod method = GENERATE(TextureMethod::gaussians, TextureMethod::recursive);
  const Device device = Device::open();
  constexpr int sizes[][2] = {{1, 1}, {7, 5}, {97, 35}, {33, 64}, {100, 3}, {2, 90}};
  Tally tally;
  for (unsigned round = 0; round < 7; ++round) {
    Random random(1000 + round);
    const auto& [width, height] = sizes[round % 6];
    // The largest one has charts, with texels between them.
    const std::optional<bool> charts = round == 2 ? std::optional(true) : std::nullopt;
    RandomTexture texture(random, {.width = width, .height = height, .method = method, .charts = charts});
    const TextureFrame frame = texture.frame();
    CAPTURE(test_seed(), round, width, height, static_cast<int>(method), texture.mm_per_texel, texture.mask.has_value(),
            texture.stretch_u.has_value(), texture.albedo.has_value());
    const oracle::TextureReference expected = expected_of(frame, texture.profile, texture.options);
    const auto stats = TexturePlan(device, texture.profile, TextureDescription::of(frame), texture.options).run(frame);
    compare(*texture.scattered, expected.scattered, expected.scattered_bound, tally);
    CHECK(texture.scattered->guards_intact());
    if (texture.result) {
      compare(*texture.result, expected.result, expected.result_bound, tally);
      CHECK(texture.result->guards_intact());
    }
    long empty = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (expected.object(x, y) == 0) ++empty;
        const bool changed = std::abs(expected.scattered(x, y, 0) - texture.light->get(x, y, 0)) > 1e-3;
        if (expected.object(x, y) == 1 && changed) ++tally.changed;
      }
    }
    CHECK(stats.texels == static_cast<long>(width) * height);
    CHECK(stats.texels_empty == empty);
    tally.empty += empty;
  }
  CHECK(tally.changed > tally.values / 20);
  CHECK(tally.empty > 20);
  // Bounds are for the worst case; roundings mostly cancel.
  CHECK(std::sqrt(tally.squared_error / tally.squared) < 5e-6);
}

TEST_CASE("recursion rounds little where exponentials are long", "[texture]") {
  const Device device = Device::open();
  struct Case {
    Profile profile;
    double width_mm;
  };
  for (const Case& what :
       {Case{dermis::preset("skin").profile, std::sqrt(7.41)}, Case{Profile::burley({1, 0.6, 0.35}), std::sqrt(7.0)}}) {
    constexpr int width = 450;
    constexpr int height = 3;
    Random random(1020);
    GuardedImage light(width, height, 3, dermis::Format::f32);
    GuardedImage scattered(width, height, 3, dermis::Format::f32);
    for (int i = 0; i < 3 * width * height; ++i) light.set(i / 3 % width, i / 3 / width, i % 3, random.uniform(0, 2));
    const TextureFrame frame{.width = width,
                             .height = height,
                             .light = light.image(),
                             .mm_per_texel = what.width_mm / 120,
                             .scattered = scattered.output()};
    const dermis::TextureOptions options{.method = TextureMethod::recursive};
    const oracle::TextureReference expected = expected_of(frame, what.profile, options);
    TexturePlan(device, what.profile, {}, options).run(frame);
    Tally tally;
    compare(scattered, expected.scattered, expected.scattered_bound, tally);
    const double rel_l2 = std::sqrt(tally.squared_error / tally.squared);
    CAPTURE(test_seed(), rel_l2);
    CHECK(rel_l2 < 5e-6);
    CHECK(rel_l2 > 0);
  }
}
