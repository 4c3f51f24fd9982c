// The light of flat blocks, computed by hand.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/flat_blocks.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

/// Scatters one line of a pass by flat weights.
std::vector<double> convolved(const std::vector<double>& x, const TapLevel& level, const Term& term, std::size_t t,
                              std::size_t terms) {
  std::vector<double> result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto weight = [&](std::size_t point) {
      return static_cast<double>(level.flat_weights[0][point * terms + t][0]);
    };
    double weights = weight(0);
    double sum = weights * x[i];
    double differences = static_cast<double>(term.sum[0]) * x[i];
    for (std::size_t pair = 0; pair < level.offsets_px.size(); ++pair) {
      for (const int sign : {-1, 1}) {
        const auto j = i + static_cast<std::size_t>(sign * level.offsets_px[pair]);  // It wraps round below 0.
        if (j >= x.size()) continue;
        weights += weight(pair + 1);
        sum += weight(pair + 1) * x[j];
        differences += weight(pair + 1) * (x[j] - x[i]);
      }
    }
    result.push_back(term.normalised ? sum / weights : differences);
  }
  return result;
}

using Lines = std::vector<std::vector<double>>;

Lines transposed(const Lines& lines) {
  Lines result(lines[0].size(), std::vector<double>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < lines[i].size(); ++j) result[j][i] = lines[i][j];
  }
  return result;
}

/// Returns the red light, row by row.
Lines light_of(const MadeFrame& made) {
  Lines rows(static_cast<std::size_t>(made.height));
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    rows[i / static_cast<std::size_t>(made.width)].push_back(static_cast<double>(made.light[3 * i]));
  }
  return rows;
}

/// Scatters the light of one term horizontally, then vertically.
Lines convolved_twice(Lines lines, const TapLevel& level, const Term& term, std::size_t t, std::size_t terms) {
  for (int pass = 0; pass < 2; ++pass) {
    for (std::vector<double>& line : lines) line = convolved(line, level, term, t, terms);
    lines = transposed(lines);
  }
  return lines;
}

}  // namespace

TEST_CASE("on a plane parallel to the screen the passes are plain convolutions", "[flat]") {
  Random random(41);
  Material material = tiny_material();
  material.taps.radius_mm = 5;
  set_levels(material.taps, {made_level(1, {1, 2, 5})}, alike({}, {}));  // Only the flat weights scatter light.
  add_term(material.taps, difference_term(0.5), alike({}, {}));
  material.taps.terms[1].scale = grey(-0.75);
  TapLevel& level = material.taps.levels[0];
  lay_flat(level, material.taps.terms, [&](std::size_t pair, std::size_t t, std::size_t) {
    return random.uniform(t == 0 ? 0.02 : -0.2, 0.2) / static_cast<double>(pair + 1);
  });
  const auto made_with = [](const Camera& camera, bool has_depth) {
    MadeFrame made(20, 18, camera, 0);
    if (has_depth) made.depth.assign(made.pixels(), 20);
    return made;
  };
  for (MadeFrame made : {made_with(one_px_per_mm, false), made_with(one_px_per_mm, true),
                         made_with(Camera::perspective(20, 20, 3, 30), true)}) {
    for (float& light : made.light) light = static_cast<float>(random.uniform(0, 1));
    const Reference reference = run_as_is(made, std::span(&material, 1));
    const Lines light = light_of(made);
    const Lines mean = convolved_twice(light, level, material.taps.terms[0], 0, 2);
    const Lines differences = convolved_twice(light, level, material.taps.terms[1], 1, 2);
    double change = 0;
    for (std::size_t y = 0; y < light.size(); ++y) {
      for (std::size_t x = 0; x < light[y].size(); ++x) {
        const double expected = mean[y][x] - 0.75 * differences[y][x];
        const double got = reference.scattered(static_cast<int>(x), static_cast<int>(y));
        if (std::abs(got - expected) > 1e-13) FAIL_CHECK(got << " for " << expected << " at " << x << ", " << y);
        change = std::max(change, std::abs(expected - light[y][x]));
      }
    }
    CHECK(change > 0.1);
    CHECK(largest(reference.scattered_bound) < 5e-6);
  }
}

TEST_CASE("a flat block seen at such an angle that the kernel is narrow has no taps", "[flat]") {
  // On the tilted plane |T| = sqrt(2), so that the radius is 0.42 px.
  Material material = telling_material(0.6);
  add_term(material.taps, difference_term(2), alike({}, {}));
  lay_flat(material.taps.levels[3], material.taps.terms,
           [](std::size_t pair, std::size_t, std::size_t) { return pair == 0 ? 0.25 : 0; });
  for (const double g : {0.0, 1.0}) {
    const MadeFrame made = row_of_blocks(16, [=](int x) { return g * x; });
    const Reference reference = run_as_is(made, std::span(&material, 1));
    // The horizontal pass takes the mean, and twice the light; the vertical one doubles the latter, as the light is the
    // same all over a column.
    const double taken = 2 * 0.25;
    CHECK(reference.scattered(5, 2) == (g == 0 ? 25 + taken + 2 * (2 * 25 + taken) : 25 + 2 * 2 * 25));
  }
}

TEST_CASE("taps that fall on another material are left out of a flat block", "[flat]") {
  const std::vector materials{telling_material(5, 1), telling_material(7, 2)};
  MadeFrame made = step(32, 8, 0);
  for (std::size_t i = 0; i < made.pixels(); ++i) made.material.push_back(i % 32 < 6 ? 1 : 2);
  const Reference reference = run_as_is(made, materials);
  CHECK(told(reference, 4, 2, false) == level_for(5));
  CHECK(told(reference, 7, 2, false) == level_for(7));
  const double left = 0.125 + level_for(5) / 1024.0;
  const double right = 0.125 + level_for(7) / 1024.0;
  CHECK(reference.scattered(5, 2) == Approx(((1 - 2 * left) * 25 + left * 16) / (1 - left)).epsilon(1e-14));
  CHECK(reference.scattered(6, 2) == Approx(((1 - 2 * right) * 36 + right * 49) / (1 - right)).epsilon(1e-14));
}

}  // namespace dermis::oracle
