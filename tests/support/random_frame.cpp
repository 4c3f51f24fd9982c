#include "support/random_frame.hpp"

#include <cmath>

using dermis::Camera;
using dermis::Format;
using dermis::Profile;

namespace {

Profile random_profile(Random& random, bool albedo) {
  const auto length = [&] { return std::exp(random.uniform(std::log(0.1), std::log(1.5))); };
  switch (random.integer(0, albedo ? 5 : 3)) {
    case 0:
      return dermis::preset("skin").profile;
    case 1:
      return Profile::burley({length(), length(), length()});
    case 2:
      return Profile::gaussians({{length(), {1, 0.5, 0.2}}, {0.1 * length(), {0, 0.5, 0.8}}});
    case 3:
      return Profile::random_walk_cycles(
          {10 * length(), 10 * length(), 10 * length()},
          {random.uniform(0.2, 0.9), random.uniform(0.2, 0.9), random.uniform(0.2, 0.9)});
    case 4:
      return Profile::random_walk_cycles({10 * length(), 10 * length(), 10 * length()});
    default:
      return Profile::burley_cycles({10 * length(), 10 * length(), 10 * length()});
  }
}

Camera random_camera(Random& random, int width, int height, double px_per_mm, double depth_units, double mm_per_unit) {
  const double stretch = random.coin() ? 1 : random.uniform(0.5, 2);
  const double px_per_unit = px_per_mm * mm_per_unit;
  if (random.integer(0, 3) == 0) return Camera::orthographic(px_per_unit, px_per_unit * stretch);
  return Camera::perspective(px_per_unit * depth_units, px_per_unit * depth_units * stretch,
                             width * random.uniform(0.2, 0.8), height * random.uniform(0.2, 0.8));
}

dermis::TapsDesign random_design(Random& random) {
  dermis::TapsDesign design;
  design.model = static_cast<dermis::Model>(random.integer(0, 5));
  if (design.model == dermis::Model::svd || design.model == dermis::Model::gaussians)
    design.rank = random.integer(1, 6);
  if (design.model == dermis::Model::optimised) design.rank = random.integer(1, 3);
  design.count = 2 * random.integer(1, 16) + 1;
  design.placement = static_cast<dermis::Placement>(random.integer(0, 3));
  design.guide = random.uniform(0, 4);
  return design;
}

}  // namespace

RandomFrame::RandomFrame(Random& random, const RandomFrameChoice& choice) : width(choice.width), height(choice.height) {
  Random* gaps = choice.with_gaps ? &random : nullptr;
  const auto color_format = [&] { return choice.float_only || random.coin() ? Format::f32 : Format::f16; };
  const bool with_albedo = random.coin();
  const bool with_mask = random.integer(0, 3) == 0;
  const bool with_matte = random.integer(0, 3) == 0;
  const bool with_beauty = random.coin();
  const bool with_normal = random.coin();

  light.emplace(width, height, 3, color_format(), gaps);
  depth.emplace(width, height, 1, Format::f32, gaps);
  scattered.emplace(width, height, 3, color_format(), gaps);
  if (with_albedo) albedo.emplace(width, height, 3, color_format(), gaps);
  if (with_normal) normal.emplace(width, height, 3, color_format(), gaps);
  if (with_mask) mask.emplace(width, height, 1, color_format(), gaps);
  if (with_matte) matte.emplace(width, height, 1, color_format(), gaps);

  const int count = choice.materials.value_or(random.integer(1, 4));
  const bool with_ids = count > 1 || random.coin();
  if (with_ids) {
    constexpr Format id_formats[] = {Format::f32, Format::u8, Format::u16, Format::u32, Format::f16};
    material.emplace(width, height, 1, id_formats[random.integer(0, 4)], gaps);
  }
  for (int i = 0; i < count; ++i) {
    materials.push_back({10 + 3 * i, random_profile(random, with_albedo)});
    if (random.integer(0, 2) == 0) materials.back().taps = random_design(random);
  }

  options.taps = random_design(random);
  options.jitter = choice.jitter.value_or(random.coin() ? 0 : random.uniform(0, 1));
  options.sheared = random.coin() || random.coin();
  options.seed = static_cast<std::uint32_t>(random.integer(0, 1 << 30));
  options.lighting = with_albedo && random.coin() ? dermis::Lighting::lit : dermis::Lighting::raw;
  if (with_albedo && random.coin()) options.albedo_mix = random.coin() ? 0.5 : random.uniform(0, 1);
  if (with_beauty && (with_albedo || options.lighting == dermis::Lighting::lit)) {
    beauty.emplace(width, height, 3, color_format(), gaps);
    result.emplace(width, height, 3, color_format(), gaps);
  }

  // With a power of two depth in mm has the mantissa of the input.
  mm_per_unit = std::ldexp(1.0, random.integer(-3, 4));
  const double depth_units = random.uniform(50, 200) / mm_per_unit;
  const double px_per_mm = std::exp(random.uniform(std::log(0.3), std::log(12)));
  camera = random_camera(random, width, height, px_per_mm, depth_units, mm_per_unit);

  const double bump_units = random.uniform(0, 8) / px_per_mm / mm_per_unit;
  const double step_units = random.uniform(0, 4) / mm_per_unit;
  const double wave = random.uniform(0.05, 0.4);
  const double split = random.uniform(0.2, 0.8) * width;
  const int patch_px = random.integer(5, 40);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool behind = x > split + 6 * std::sin(0.3 * y);
      const bool background = random.integer(0, 60) == 0;
      depth->set(x, y, 0,
                 background ? 1e10
                            : depth_units + (behind ? step_units : 0) +
                                  bump_units * std::sin(wave * x) * std::cos(0.7 * wave * y));
      const bool lit = (x / 9 + y / 5) % 3 != 0;
      for (int c = 0; c < 3; ++c) {
        light->set(x, y, c, (lit ? 1 : 0.05) * random.uniform(0.5, 1.5));
        if (albedo) albedo->set(x, y, c, random.integer(0, 40) == 0 ? 0 : random.uniform(0.1, 1));
        if (beauty) beauty->set(x, y, c, random.uniform(0, 4));
      }
      if (normal) {
        // Of any length, here and there of none or not a number.
        const int kind = random.integer(0, 60);
        const double length = kind == 0 ? 0 : kind == 1 ? NAN : random.uniform(0.5, 2);
        normal->set(x, y, 0, length * 0.5 * std::sin(wave * x));
        normal->set(x, y, 1, length * 0.7 * std::cos(0.6 * wave * y));
        normal->set(x, y, 2, -length);
      }
      if (mask) mask->set(x, y, 0, random.integer(0, 9) == 0 ? 0 : random.uniform(0.3, 1));
      // Pixels are covered in part along the edges of the light, and here and there.
      const bool partial = random.integer(0, 30) == 0 || (x % 9 == 0 && 2 * y < height);
      if (matte) matte->set(x, y, 0, partial ? random.uniform(0, 1) : 1);
      if (material) {
        // The patches take turns; one in count + 1 has no material.
        const int turn = (x / patch_px + 2 * (y / patch_px)) % (count + 1);
        material->set(x, y, 0, turn == count ? 3 : materials[turn].id);
      }
    }
  }
}

dermis::Frame RandomFrame::frame() {
  dermis::Frame frame{.width = width, .height = height, .camera = camera, .mm_per_unit = mm_per_unit};
  frame.light = light->image();
  frame.depth = depth->image();
  frame.scattered = scattered->output();
  if (albedo) frame.albedo = albedo->image();
  if (material) frame.material = material->image();
  if (mask) frame.mask = mask->image();
  if (matte) frame.matte = matte->image();
  if (normal) frame.normal = normal->image();
  if (beauty) frame.beauty = beauty->image();
  if (result) frame.result = result->output();
  return frame;
}
