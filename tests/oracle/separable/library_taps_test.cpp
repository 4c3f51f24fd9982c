// The oracle with the library's own taps and profiles.
#include <algorithm>
#include <cmath>
#include <span>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "dermis/profile.hpp"
#include "oracle/support/made_frame.hpp"
#include "oracle/support/separable_run.hpp"
#include "support/catch.hpp"

namespace dermis::oracle {

namespace {

Material material_of(const Profile& profile, int taps, int id = 1) {
  Material material;
  material.id = id;
  material.taps =
      make_taps(profile, {.model = Model::pre_integrated, .count = taps, .placement = Placement::importance});
  material.radial = [profile](int c, double r) { return profile.radial(c, r); };
  material.cdf = [profile](int c, double r) { return profile.cdf(c, r); };
  return material;
}

/// Returns the largest distance of a filtered step from the profile's own edge, on flat and on curved blocks at about 4
/// px per mm: at the pixels per mm of a level, where its weights are exact.
double edge_error(const Profile& profile, int taps) {
  const Material material = material_of(profile, taps);
  const int index = Taps::level_index(static_cast<float>(4 * material.taps.radius_mm));
  const auto px_per_mm = static_cast<double>(material.taps.levels[static_cast<std::size_t>(index)].px_per_mm);
  const int half = 24;
  MadeFrame made(2 * half, 1, Camera::orthographic(px_per_mm, px_per_mm), 0);
  for (int x = half; x < 2 * half; ++x) MadeFrame::set_rgb(made.light, static_cast<std::size_t>(x), 1, 1, 1);
  double worst = 0;
  for (const MadeFrame& either : {made, never_flat(made)}) {
    const Reference reference = separable(either.frame(), std::span(&material, 1), {});
    for (int x = half - 4; x < half + 4; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double edge = profile.edge(c, (x + 0.5 - half) / px_per_mm);
        worst = std::max(worst, std::abs(reference.scattered(x, 0, c) - edge));
      }
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("a step on a plane becomes the library's edge profile", "[library_taps]") {
  const Profile gaussian = Profile::gaussians({{1, {1, 1, 1}}});
  // The kernel reaches 3.3 mm, 13 px: with 63 taps each is one pixel wide.
  CHECK(edge_error(gaussian, 63) < 1e-4);
  CHECK(edge_error(Profile::burley({0.5, 0.4, 0.3}), 63) < 2e-3);
}

TEST_CASE("separable and exact agree on smooth light", "[library_taps]") {
  // A Gaussian is separable: the passes differ from the integral only by the taps and by what the image cuts off.
  Scene scene = oracle::scene("step", 40, 24, 2, Camera::Projection::orthographic);
  const Material material = material_of(Profile::gaussians({{4, {1, 1, 1}}}), 63);
  const Picture passes = separable(scene.frame(), std::span(&material, 1), {}).scattered;
  const Picture integral = surface_integral(scene.frame(), std::span(&material, 1), {}).scattered;
  const Difference difference = compare(passes, integral);
  CHECK(difference.relative_l2 < 3e-3);
  Picture light(40, 24, 3);
  light.values.assign(scene.light.begin(), scene.light.end());
  CHECK(compare(light, integral).relative_l2 > 0.1);
}

TEST_CASE("bounds are narrow with the library's taps", "[library_taps]") {
  const Scene scene = oracle::scene("sphere", 96, 96);
  const Material material = material_of(preset("skin").profile, 25);
  const Reference reference = separable(scene.frame(), std::span(&material, 1), {});
  const auto& bounds = reference.scattered_bound.values;
  CHECK(*std::max_element(bounds.begin(), bounds.end()) < 5e-5);
  CHECK(*std::max_element(bounds.begin(), bounds.end()) > 1e-7);
}

}  // namespace dermis::oracle
