// Light of any size: scales, fireflies, signs, denormals, half.
#include <cmath>
#include <limits>

#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

constexpr const char* group = "light";
constexpr double nothing_promised = std::numeric_limits<double>::infinity();

void scale(StressField& field, double factor) {
  for (float& value : field.light) value = static_cast<float>(value * factor);
}

/// Sets five values of the picture, anywhere.
void add_fireflies(StressField& field, std::mt19937& engine, float value) {
  for (int i = 0; i < 5; ++i) field.light[engine() % field.light.size()] = value;
}

StressRow negated(const StressFilter& flat, const StressField& field) {
  StressField dark = field;
  scale(dark, -1);
  StressRow row = judged(flat, dark, group, "negative", {.white = -0.7});
  const StressResult light = flat.run(field);
  const StressResult mirror = flat.run(dark);
  for (std::size_t i = 0; i < light.bits.size(); ++i) {
    if (light.values.values[i] != -mirror.values.values[i]) {
      fail(row, "not minus what the light gives");
      break;
    }
  }
  return row;
}

/// Scales each value by a random power of ten, from `low` to `high`.
StressField of_mixed_size(const StressField& field, std::mt19937& engine, double low, double high) {
  StressField mixed = field;
  for (float& value : mixed.light) value = static_cast<float>(value * std::pow(10.0, uniform(engine, low, high)));
  return mixed;
}

}  // namespace

void add_light_cases(std::vector<StressRow>& rows, const StressFilter& flat, std::mt19937& engine) {
  const StressField field = stress_plane(engine, 80, 48, uniform(engine, 2, 6));
  for (const int decade : {-30, -20, -10, 0, 10, 20, 30}) {
    StressField scaled = field;
    scale(scaled, std::pow(10.0, decade));
    const std::string name = decade == 0 ? "about 1" : "1e" + std::to_string(decade);
    rows.push_back(judged(flat, scaled, group, name, {.white = 0.7 * std::pow(10.0, decade)}));
  }
  rows.push_back(judged(flat, of_mixed_size(field, engine, -6, 6), group, "1e-6 to 1e6 mixed"));
  rows.push_back(judged(flat, of_mixed_size(field, engine, -30, 30), group, "1e-30 to 1e30 mixed"));
  for (const float value : {65504.0F, 1e20F}) {
    StressField fireflies = field;
    add_fireflies(fireflies, engine, value);
    rows.push_back(judged(flat, fireflies, group, value < 1e6F ? "fireflies 65504" : "fireflies 1e20"));
  }
  rows.push_back(negated(flat, field));
  StressField signs = field;
  for (float& value : signs.light) value = (engine() & 1U) != 0 ? value : -value;
  rows.push_back(judged(flat, signs, group, "mixed signs"));
  // Nothing relative can be promised of what may be flushed to zero.
  const StressPromise absolute{
      .rel_l2 = nothing_promised, .energy = nothing_promised, .white = 0.7e-36, .sure_values_only = false};
  rows.push_back(judged(flat, of_mixed_size(field, engine, -41, -34), group, "denormal 1e-41 to 1e-34", absolute));

  // A unit in the last place of a half is at most 2^-10 of the value. Constant light of a half comes out as the half
  // that it was, since 2e-6 is far below half a unit.
  const StressPromise rounded{.rel_l2 = 0x1p-11, .energy = 0};
  StressField half = field;
  half.format = Format::f16;
  rows.push_back(judged(flat, half, group, "half", rounded));
  StressField fireflies = half;
  add_fireflies(fireflies, engine, 65504);
  rows.push_back(judged(flat, fireflies, group, "half, fireflies 65504", rounded));
  // Below 2^-14 halfs lie 2^-24 apart however small they are.
  StressField small = half;
  scale(small, 1e-5);
  rows.push_back(
      judged(flat, small, group, "half, denormal 1e-5", {.rel_l2 = nothing_promised, .energy = 0, .white = 0.7e-5}));
}

}  // namespace dermis::bench
