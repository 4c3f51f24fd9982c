#include "texture/random_texture.hpp"

#include <cmath>
#include <limits>

using dermis::Format;
using dermis::Profile;

namespace {

Profile random_profile(Random& random) {
  const auto length = [&] { return std::exp(random.uniform(std::log(0.1), std::log(1.5))); };
  switch (random.integer(0, 2)) {
    case 0:
      return dermis::preset("skin").profile;
    case 1:
      return Profile::burley({length(), length(), length()});
    default:
      return Profile::gaussians({{length(), {1, 0.5, 0.2}}, {0.1 * length(), {0, 0.5, 0.8}}});
  }
}

}  // namespace

RandomTexture::RandomTexture(Random& random, const RandomTextureChoice& choice)
    : width(choice.width),
      height(choice.height),
      profile(random_profile(random)),
      options({.method = choice.method}),
      mm_per_texel(std::exp(random.uniform(std::log(0.08), std::log(2)))) {
  Random* gaps = choice.with_gaps ? &random : nullptr;
  const auto format = [&] { return random.coin() ? Format::f32 : Format::f16; };
  const bool with_albedo = choice.albedo.value_or(random.coin());
  const bool with_mask = choice.charts.value_or(random.coin());
  const bool with_stretch = choice.stretch.value_or(random.coin());
  light.emplace(width, height, 3, format(), gaps);
  scattered.emplace(width, height, 3, format(), gaps);
  if (with_albedo) {
    albedo.emplace(width, height, 3, format(), gaps);
    result.emplace(width, height, 3, format(), gaps);
    options.albedo_mix = random.coin() ? 0.82 : random.integer(0, 1);
  }
  if (with_mask) mask.emplace(width, height, 1, format(), gaps);
  if (with_stretch) {
    stretch_u.emplace(width, height, 1, format(), gaps);
    stretch_v.emplace(width, height, 1, format(), gaps);
  }
  const double wave = random.uniform(0.02, 0.3);
  const double bump = random.uniform(0, 0.7);
  const int chart_px = random.integer(4, 40);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool lit = (x / 9 + y / 5) % 3 != 0;
      const bool bad = random.integer(0, 200) == 0;
      for (int c = 0; c < 3; ++c) {
        light->set(x, y, c, (lit ? 1 : 0.05) * random.uniform(0.5, 1.5));
        if (albedo) albedo->set(x, y, c, random.integer(0, 40) == 0 ? 0 : random.uniform(0.1, 1));
      }
      if (bad) light->set(x, y, random.integer(0, 2), std::numeric_limits<double>::quiet_NaN());
      if (mask) mask->set(x, y, 0, std::hypot(x % chart_px - chart_px / 2, y % chart_px - chart_px / 2) < chart_px / 2);
      if (stretch_u) {
        stretch_u->set(x, y, 0, mm_per_texel * (1 + bump * std::sin(wave * x) * std::cos(wave * y)));
        stretch_v->set(x, y, 0, random.integer(0, 100) == 0 ? 0 : 1.7 * mm_per_texel * (1 + bump * std::sin(wave * y)));
      }
    }
  }
}

dermis::TextureFrame RandomTexture::frame() {
  dermis::TextureFrame frame{.width = width, .height = height, .mm_per_texel = mm_per_texel};
  frame.light = light->image();
  frame.scattered = scattered->output();
  if (albedo) frame.albedo = albedo->image();
  if (mask) frame.mask = mask->image();
  if (stretch_u) frame.stretch_u = stretch_u->image();
  if (stretch_v) frame.stretch_v = stretch_v->image();
  if (result) frame.result = result->output();
  return frame;
}
