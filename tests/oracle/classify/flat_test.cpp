// The classification of blocks, decided by hand.
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <vector>

#include "dermis/oracle/reference.hpp"
#include "oracle/support/flat_blocks.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/made_taps.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

namespace {

std::set<int> flat_blocks(const MadeFrame& made, const Material& material) {
  const Reference reference = run_as_is(made, std::span(&material, 1));
  const MadeFrame turned = transposed(made);
  const Reference vertical = run_as_is(turned, std::span(&material, 1));
  std::set<int> blocks;
  for (int block = 0; 16 * block < made.width; ++block) {
    const int level = told(reference, 16 * block + 8, 2, false);
    CHECK(told(vertical, 2, 16 * block + 8, true) == level);
    if (level != not_flat) blocks.insert(block);
  }
  return blocks;
}

/// Returns the level in the middle of the first block of a row.
int first_level(const MadeFrame& made, const Material& material) {
  return told(run_as_is(made, std::span(&material, 1)), 2, 2, false);
}

}  // namespace

TEST_CASE("a tilted plane is flat, and has the level of its own pixels per mm", "[flat]") {
  // The position changes by (1 / F, 0, g) per pixel along the tilt, and by 1 / F across it; F are the pixels per mm.
  for (const double px_per_mm : {2.0, 4.0}) {
    for (const double g : {0.0, 0.125, 0.25, 1.0, -0.5}) {
      INFO(px_per_mm << " px per mm, depth grows by " << g << " per px");
      MadeFrame made = row_of_blocks(40, [=](int x) { return 100 + g * x; });
      made.camera = Camera::orthographic(px_per_mm, 8);
      const Material material = telling_material(5);
      CHECK(first_level(made, material) == level_for(5 / std::hypot(1 / px_per_mm, g)));
      light_squares(made, true);
      CHECK(told(run_as_is(made, std::span(&material, 1)), 2, 2, true) == level_for(5 * 8));
    }
  }
}

TEST_CASE("the change of position under a perspective camera by hand", "[flat]") {
  // The depth goes from 10 to 10.25 over three pixels, and the ray through the middle of the block, at (8, 8), is
  // (6.5 / 40, 7 / 50).
  MadeFrame made(3, 2, Camera::perspective(40, 50, 1.5, 1));
  made.depth = {10, 10.125F, 10.25F, 10, 10.125F, 10.25F};
  light_squares(made, false);
  const double g = 0.125;
  const double along = 10.125 / 40 + 6.5 / 40 * g;
  const double across = 7.0 / 50 * g;
  for (const double radius_mm : {3.0, 5.0, 7.0}) {
    const int level = level_for(radius_mm / std::sqrt(along * along + across * across + g * g));
    const Material material = telling_material(radius_mm);
    CHECK(told(run_as_is(made, std::span(&material, 1)), 1, 0, false) == level);
    CHECK(told(run_as_is(transposed(made), std::span(&material, 1)), 0, 1, true) == level);
  }
  // Far off axis the depth grows against the ray.
  made.camera.center_x = 400;
  const Material material = telling_material(3);
  const double other = 10.125 / 40 - 392.0 / 40 * g;
  CHECK(told(run_as_is(made, std::span(&material, 1)), 1, 0, false) ==
        level_for(3 / std::sqrt(other * other + across * across + g * g)));
}

TEST_CASE("a step is not flat within reach, and flat beyond", "[flat]") {
  // Blocks count that lie at least partly within 9/8 of the distance of a block's farthest tap: 5, 16, 18 and 37 px.
  using Blocks = std::set<int>;
  CHECK(flat_blocks(step(96, 50, 0), telling_material(5)) == Blocks{0, 1, 2, 3, 4, 5});
  CHECK(flat_blocks(step(96, 50, 10), telling_material(5)) == Blocks{0, 1, 5});
  CHECK(flat_blocks(step(96, 50, 10), telling_material(0.9)) == Blocks{0, 1, 5});
  CHECK(flat_blocks(step(96, 50, 10), telling_material(15.5)) == Blocks{0, 1, 5});
  CHECK(flat_blocks(step(96, 50, 10), telling_material(16.5)) == Blocks{0});
  CHECK(flat_blocks(step(96, 50, 10), telling_material(33)).empty());
  // A step between two blocks shows in the depths of both.
  CHECK(flat_blocks(step(96, 48, 10), telling_material(5)) == Blocks{0, 1, 4, 5});
}

TEST_CASE("what lies beside the blocks of a pass does not count", "[flat]") {
  MadeFrame made(20, 40, one_px_per_mm);
  for (int i = 0; i < 20 * 40; ++i) made.depth.push_back(i / 20 < 20 ? 1 : 9);  // The step is between rows 19 and 20.
  light_squares(made, false);
  const Material material = telling_material(5);
  const Reference reference = run_as_is(made, std::span(&material, 1));
  CHECK(told(reference, 4, 4, false) == level_for(5));
  CHECK(told(reference, 4, 39, false) == level_for(5));
  // A pass along the step does not cross it.
  CHECK(told(reference, 4, 24, false) == level_for(5));
  light_squares(made, true);
  const Reference vertical = run_as_is(made, std::span(&material, 1));
  for (const int y : {4, 24, 36}) CHECK(told(vertical, 4, y, true) == not_flat);
}

TEST_CASE("how much the depth may vary", "[flat]") {
  // Across a step by D the differences are 0 and D, and T = (1, 0, D / 2): it is flat if D^2 / 4 <= (1 + D^2 / 4) / 25.
  const Material material = telling_material(5);
  CHECK(first_level(step(16, 8, 0.4), material) == level_for(5 / std::hypot(1, 0.2)));
  CHECK(first_level(step(16, 8, 0.408), material) == level_for(5 / std::hypot(1, 0.204)));
  CHECK(first_level(step(16, 8, 0.4085), material) == not_flat);
  // The depth is tilted one way, then the other.
  CHECK(first_level(row_of_blocks(16, [](int x) { return 0.199 * std::abs(x - 8); }), material) == level_for(5));
  CHECK(first_level(row_of_blocks(16, [](int x) { return 0.201 * std::abs(x - 8); }), material) == not_flat);
}

TEST_CASE("surfaces of two materials one behind the other are a step", "[flat]") {
  // No slope is taken between the two. The block is flat if its range of depths is no more than what its slopes and one
  // pixel more amount to.
  const std::vector materials{telling_material(5, 1), telling_material(5, 2)};
  const auto level = [&](double slope, double gap_mm) {
    MadeFrame made = row_of_blocks(16, [=](int x) { return 50 + slope * x + (x < 8 ? 0 : gap_mm); });
    for (std::size_t i = 0; i < made.pixels(); ++i) made.material.push_back(i % 16 < 8 ? 1 : 2);
    return told(run_as_is(made, materials), 2, 2, false);
  };
  CHECK(level(0, 0.99) == level_for(5));
  CHECK(level(0, 1.01) == not_flat);
  // The range is 15 slopes and the gap; the limit is 16 slopes and |T|.
  const double change = std::hypot(1, 0.125);
  CHECK(level(0.125, 0.125 + change - 0.01) == level_for(5 / change));
  CHECK(level(0.125, 0.125 + change + 0.01) == not_flat);
}

TEST_CASE("a wide kernel in a block makes all of it look further", "[flat]") {
  const std::vector materials{telling_material(5, 1), telling_material(40, 2)};
  MadeFrame made = step(96, 50, 10);
  made.material.assign(made.pixels(), 1);
  CHECK(told(run_as_is(made, materials), 8, 2, false) == level_for(5));
  made.material[4 * 96 + 15] = 2;
  CHECK(told(run_as_is(made, materials), 8, 2, false) == not_flat);
}

TEST_CASE("pixels with widths of their own and rotated taps are never flat", "[flat]") {
  Material material = telling_material(5, 1);
  const MadeFrame made = step(32, 8, 0);
  CHECK(first_level(made, material) == level_for(5));
  CHECK(first_level(never_flat(made), material) == not_flat);
  Options options;
  options.jitter = 0.01;
  CHECK(told(run_as_is(made, std::span(&material, 1), options), 8, 2, false) == not_flat);
  // One material whose width follows the albedo is enough, even if no pixel has it.
  MadeFrame with_albedo = made;
  with_albedo.albedo.assign(3 * made.pixels(), 0.5F);
  with_albedo.material.assign(made.pixels(), 1);
  std::vector materials{material, telling_material(5, 2)};
  CHECK(told(run_as_is(with_albedo, materials), 8, 2, false) == level_for(5));
  materials[1].albedo_width = Profile::burley_cycles({1, 1, 1}).albedo_width();
  CHECK(told(run_as_is(with_albedo, materials), 8, 2, false) == not_flat);
}

TEST_CASE("the bound admits that a block is flat or not where float32 cannot tell", "[flat]") {
  const Material material = telling_material(5);
  const auto bound = [](const MadeFrame& made, const Material& its, int x) {
    return run_as_is(made, std::span(&its, 1)).scattered_bound(x, 2);
  };
  const double share = static_cast<double>(Taps::flatness);
  const double just = 2 * share / std::sqrt(1 - share * share);
  const auto at_zero = [](double by_mm) {  // Depths about 0 are those that float32 resolves best.
    return row_of_blocks(16, [=](int x) { return x < 8 ? 0 : by_mm; });
  };
  const double taken = 2 * (0.125 + level_for(5 / std::hypot(1, just / 2)) / 1024.0);
  CHECK(bound(at_zero(just), material, 4) == Approx(taken).epsilon(1e-3));
  CHECK(bound(at_zero(just * 0.9999), material, 4) < 1e-4);
  CHECK(bound(at_zero(just * 1.0001), material, 4) < 1e-4);
  // The reach is 16 pixels, or 18.
  CHECK(bound(step(96, 50, 10), telling_material(16), 24) > 0.2);
  CHECK(bound(step(96, 50, 10), telling_material(15.9), 24) < 2e-3);
  CHECK(bound(step(96, 50, 10), telling_material(16.1), 24) < 2e-3);
}

}  // namespace dermis::oracle
