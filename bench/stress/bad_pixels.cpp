// Pixels that hold no light: not finite, or no depth.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <set>

#include "dermis/error.hpp"
#include "stress/cases.hpp"
#include "stress/judgement.hpp"

namespace dermis::bench {

namespace {

constexpr const char* group = "bad light";
constexpr float background = 1e10F;

/// A NaN whose bits can be recognised.
float marked_nan() { return std::bit_cast<float>(0xffcabcdeU); }

/// About one in `rarity` of the pixels that see the surface, now and then with a neighbour.
std::set<std::size_t> chosen_pixels(const StressField& field, std::mt19937& engine, int rarity) {
  std::set<std::size_t> chosen;
  for (std::size_t i = 0; i < field.pixels(); ++i) {
    if (field.depth[i] < background && engine() % static_cast<unsigned>(rarity) == 0) {
      chosen.insert(i);
      if (engine() % 4 == 0 && i + 1 < field.pixels() && field.depth[i + 1] < background) chosen.insert(i + 1);
    }
  }
  return chosen;
}

/// Sets the light of some pixels.
StressField with_light(StressField field, const std::set<std::size_t>& pixels, float value) {
  for (const std::size_t pixel : pixels) std::fill_n(&field.light[3 * pixel], 3, value);
  return field;
}

/// Counts the values that have other bits, except at `pixels`.
long other_bits(const StressResult& a, const StressResult& b, const std::set<std::size_t>& pixels) {
  long count = 0;
  for (std::size_t i = 0; i < a.bits.size(); ++i) {
    if (!pixels.contains(i / 3) && a.bits[i] != b.bits[i]) ++count;
  }
  return count;
}

void check_elsewhere(StressRow& row, const StressResult& seen, const StressResult& expected,
                     const std::set<std::size_t>& pixels) {
  if (pixels.empty() || expected.stats.pixels_scattered < static_cast<long>(expected.bits.size() / 3 / 4)) {
    fail(row, "nothing was there to see");
  }
  const long others = other_bits(seen, expected, pixels);
  if (others > 0)
    fail(row, std::to_string(others) + " values elsewhere differ from those with something else that is bad there");
  for (std::size_t i = 0; i < seen.bits.size(); ++i) {
    if (!pixels.contains(i / 3) && !std::isfinite(seen.values.values[i])) ++row.non_finite;
  }
  if (row.non_finite > 0) fail(row, std::to_string(row.non_finite) + " values elsewhere are not finite");
}

void check_kept(StressRow& row, const StressResult& seen, const std::set<std::size_t>& pixels) {
  for (const std::size_t pixel : pixels) {
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      if (seen.bits[i] != seen.input_bits[i]) return fail(row, "its bits are not kept");
    }
  }
}

void check_count(StressRow& row, const StressResult& seen, std::size_t bad) {
  if (seen.stats.pixels_bad != static_cast<std::int64_t>(bad)) {
    fail(row, std::to_string(seen.stats.pixels_bad) + " bad pixels counted, not " + std::to_string(bad));
  }
}

/// `value` in one channel of some pixels, or in all.
StressField spoilt(const StressField& field, const std::set<std::size_t>& pixels, float value, std::mt19937& engine) {
  StressField bad = field;
  for (const std::size_t pixel : pixels) {
    const std::size_t channels = engine() % 3 == 0 ? 3 : 1;
    const std::size_t first = channels == 3 ? 0 : engine() % 3;
    for (std::size_t c = first; c < first + channels; ++c) bad.light[3 * pixel + c] = value;
  }
  return bad;
}

StressRow kept(const StressFilter& deep, const StressField& field, const std::string& name, float value,
               std::mt19937& engine) {
  StressRow row{.group = group, .name = name, .promised = "own pixel only, keeps bits"};
  const std::set<std::size_t> pixels = chosen_pixels(field, engine, 80);
  const StressResult seen = deep.run(spoilt(field, pixels, value, engine));
  check_elsewhere(row, seen, deep.run(with_light(field, pixels, -HUGE_VALF)), pixels);
  check_kept(row, seen, pixels);
  check_count(row, seen, pixels.size());
  return row;
}

/// Nowhere is the light finite.
StressRow all_bad(const StressFilter& deep, StressField field) {
  StressRow row{.group = group, .name = "NaN everywhere", .promised = "keeps bits"};
  std::size_t on_surface = 0;
  for (std::size_t i = 0; i < field.pixels(); ++i) on_surface += field.depth[i] < background ? 1 : 0;
  std::fill(field.light.begin(), field.light.end(), marked_nan());
  const StressResult seen = deep.run(field);
  if (seen.bits != seen.input_bits) fail(row, "bits changed");
  check_count(row, seen, on_surface);
  return row;
}

StressRow zeroed(const Device& device, const std::vector<Material>& materials, Options options,
                 const StressField& field, std::mt19937& engine) {
  StressRow row{.group = group, .name = "zeroed", .promised = "own pixel only, 0"};
  options.bad_pixels = BadPixels::zero;
  const StressFilter filter(device, materials, {.depth = true}, options);
  const std::set<std::size_t> pixels = chosen_pixels(field, engine, 80);
  const StressResult seen = filter.run(spoilt(field, pixels, marked_nan(), engine));
  check_elsewhere(row, seen, filter.run(with_light(field, pixels, -HUGE_VALF)), pixels);
  check_count(row, seen, pixels.size());
  for (const std::size_t pixel : pixels) {
    if (seen.bits[3 * pixel] != 0 || seen.bits[3 * pixel + 1] != 0 || seen.bits[3 * pixel + 2] != 0) {
      fail(row, "not zero");
      break;
    }
  }
  return row;
}

StressRow refused(const Device& device, const std::vector<Material>& materials, Options options,
                  const StressField& field) {
  StressRow row{.group = group, .name = "refused", .promised = "one bad pixel ends the run"};
  options.bad_pixels = BadPixels::error;
  const Plan plan(device, materials, {.depth = true}, options);
  StressField bad = field;
  std::vector<float> scattered(field.light.size(), 12345);
  Frame frame{.width = field.width_px, .height = field.height_px, .camera = field.camera};
  frame.light.host = bad.light.data();
  frame.depth.host = bad.depth.data();
  frame.scattered.host = scattered.data();
  const auto error_of = [&]() -> std::optional<std::string> {
    try {
      plan.run(frame);
    } catch (const Error& error) {
      return error.what();
    }
    return std::nullopt;
  };
  std::size_t pixel = field.pixels() / 2;
  while (bad.depth[pixel] >= background) ++pixel;
  bad.light[3 * pixel + 1] = HUGE_VALF;
  if (!error_of()) fail(row, "it is not");
  if (std::count(scattered.begin(), scattered.end(), 12345.0F) != static_cast<long>(scattered.size())) {
    fail(row, "something was written");
  }
  bad.light[3 * pixel + 1] = 0.5F;
  if (const auto error = error_of()) fail(row, "good light is refused too: " + *error);
  return row;
}

}  // namespace

StressRow missing_depth(const StressFilter& deep, const StressField& field, std::mt19937& engine) {
  StressRow row{.group = "depth", .name = "0, negative, NaN, Inf, 1e-30, 1e10", .promised = "background, keeps bits"};
  const float values[] = {0, -0.0F, -100, 1e-30F, marked_nan(), HUGE_VALF, -HUGE_VALF, 1e9F, background, 3e38F};
  const std::set<std::size_t> pixels = chosen_pixels(field, engine, 20);
  StressField bad = field;
  for (const std::size_t pixel : pixels) {
    bad.depth[pixel] = values[engine() % std::size(values)];
    bad.light[3 * pixel] = engine() % 4 == 0 ? marked_nan() : 1000;  // no filter may read it
  }
  const StressResult seen = deep.run(bad);
  StressField without = with_light(field, pixels, 77);  // it would show if it were read
  for (const std::size_t pixel : pixels) without.depth[pixel] = background;
  const StressResult expected = deep.run(without);
  check_elsewhere(row, seen, expected, pixels);
  check_kept(row, seen, pixels);
  check_count(row, seen, 0);
  if (seen.stats.pixels_without_material != expected.stats.pixels_without_material) fail(row, "counted otherwise");
  return row;
}

void add_bad_light_cases(std::vector<StressRow>& rows, const Device& device, const StressFilter& deep,
                         std::mt19937& engine) {
  const StressField field = stress_surface(engine, 80, 48, 400, 100, 1);
  rows.push_back(kept(deep, field, "NaN", marked_nan(), engine));
  rows.push_back(kept(deep, field, "+Inf", HUGE_VALF, engine));
  rows.push_back(kept(deep, field, "-Inf", -HUGE_VALF, engine));
  StressField half = field;
  half.format = Format::f16;
  rows.push_back(kept(deep, half, "NaN in half", marked_nan(), engine));
  rows.push_back(kept(deep, half, "1e6, Inf in half", 1e6F, engine));
  rows.push_back(kept(deep, field, "1e33", 1e33F, engine));
  rows.push_back(kept(deep, field, "-3e38", -3e38F, engine));
  rows.push_back(all_bad(deep, field));
  // Few taps do: the cases are about pixels.
  const std::vector<Material> materials = {{0, preset("skin").profile}};
  const Options cheap{.taps = {.model = Model::pre_integrated, .count = 7, .placement = Placement::importance}};
  rows.push_back(zeroed(device, materials, cheap, field, engine));
  rows.push_back(refused(device, materials, cheap, field));
}

}  // namespace dermis::bench
