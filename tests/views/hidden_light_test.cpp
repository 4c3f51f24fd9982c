// Light of views equals the oracle's sums, and what is known of it on a sphere.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "closed_scene.hpp"
#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/materials.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/compare_light.hpp"

using dermis::Camera;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Lighting;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;
namespace oracle = dermis::oracle;

namespace {

/// The light after scattering.
oracle::Picture scattered(Frame frame, const std::vector<dermis::Material>& materials, const Options& options) {
  std::vector<float> light(3 * static_cast<std::size_t>(frame.width) * frame.height);
  frame.scattered.host = light.data();
  Plan(Device::open(), materials, FrameDescription::of(frame), options).run(frame);
  return picture_of(frame.width, frame.height, light);
}

double whole(double seen_weight, double hidden_weight) {
  return std::min(std::min(seen_weight, 1.0) + hidden_weight, 1.0);
}

/// Joins light that scattered over the visible surface with that of the hidden one.
oracle::Picture joined(const oracle::Picture& seen, const oracle::Picture& seen_weights,
                       const oracle::HiddenLight& hidden) {
  oracle::Picture all = seen;
  for (std::size_t i = 0; i < all.values.size(); ++i) {
    if (hidden.weight.values[i] == 0) continue;
    const double weight = seen_weights.values[i];
    const double light = seen.values[i] * std::min(weight, 1.0) + hidden.light.values[i];
    const double bent = std::clamp(light + hidden.bent.values[i], light / 4, 4 * light);
    all.values[i] = bent / whole(weight, hidden.weight.values[i]);
  }
  return all;
}

/// The root of the sum of squares over the pixels of a mask.
double norm_of(const oracle::Picture& picture, const oracle::Picture& where) {
  double sum = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      for (int c = 0; c < 3; ++c) sum += where(x, y) * picture(x, y, c) * picture(x, y, c);
    }
  }
  return std::sqrt(sum);
}

/// How light goes from where it enters to where it leaves.
enum class Crossing { distance, projected, walk };

std::vector<dermis::Material> random_walks(Random& random) {
  std::vector<dermis::Material> materials;
  for (const int id : {1, 2}) {
    dermis::Rgb mfp_mm{}, albedo{};
    for (int c = 0; c < 3; ++c) {
      mfp_mm[c] = random.uniform(2, 5);
      albedo[c] = random.uniform(0.5, 0.9);
    }
    materials.push_back({id, Profile::random_walk_mfp(mfp_mm, albedo)});
  }
  return materials;
}

std::vector<dermis::Material> random_materials(Random& random, Crossing crossing) {
  if (crossing == Crossing::walk) return random_walks(random);
  const auto length = [&](double factor) { return factor * random.uniform(0.5, 3); };
  std::vector<dermis::Material> materials = {{1, Profile::burley({length(1), length(1), length(1)})},
                                             {2, Profile::burley_cycles({length(12), length(12), length(12)})}};
  if (crossing == Crossing::projected) {
    for (dermis::Material& material : materials) material.profile = material.profile.projected();
  }
  return materials;
}

/// A scene, and a frame of it with its views. It stays where it is.
struct Shown {
  ClosedScene scene;
  std::vector<dermis::View> views = scene.views();
  Frame frame = scene.frame();
  std::vector<float> black = std::vector<float>(3 * scene.front.pixels(), 0.0F);
  std::vector<float> white = std::vector<float>(3 * scene.front.pixels(), 1.0F);

  explicit Shown(ClosedScene its_scene) : scene(std::move(its_scene)) { frame.views = views; }
  Shown(const Shown&) = delete;

  Frame with_light(const std::vector<float>& light) const {
    Frame lit = frame;
    lit.light.host = light.data();
    return lit;
  }
};

constexpr std::array subjects = {Subject::sphere, Subject::flat, Subject::two};

Place random_place(Random& random) { return random.coin() ? Place::behind : Place::corners; }

}  // namespace

// Device and oracle differ by the samples that the device joins, and by light from beyond the reach: without those they
// agree to 1e-5. In 20 seeds all light is up to 0.5 % off, hidden light 1.1 %; of projected profiles 1.2 % and 1.9 %.
TEST_CASE("hidden light equals the sums of the oracle", "[views]") {
  const Crossing crossing = GENERATE(Crossing::distance, Crossing::projected, Crossing::walk);
  const bool is_projected = crossing == Crossing::projected;
  double largest_effect = 0;
  for (const Subject subject : subjects) {
    Random random(10 + 5 * static_cast<unsigned>(subject) + static_cast<unsigned>(crossing));
    Shown shown(closed_scene(random, subject, random_place(random)));
    shown.frame.mm_per_unit = random.uniform(0.7, 1.4);
    const std::vector<dermis::Material> materials = random_materials(random, crossing);
    const Options options{.method = Method::exact, .lighting = random.coin() ? Lighting::lit : Lighting::raw};
    const auto as_oracle = dermis::oracle::materials_of(materials, options.taps);
    const oracle::Reference seen = oracle::surface_integral(shown.frame, as_oracle, options);
    const oracle::HiddenLight hidden = oracle::hidden_light(shown.frame, as_oracle, options);
    CAPTURE(test_seed(), static_cast<int>(crossing), static_cast<int>(subject));

    const oracle::Picture expected = joined(seen.scattered, seen.weights, hidden);
    const oracle::Picture all = scattered(shown.frame, materials, options);
    const double error = oracle::compare(all, expected, seen.touched).relative_l2;
    const double effect = oracle::compare(seen.scattered, expected, seen.touched).relative_l2;

    oracle::Picture light = scattered(shown.with_light(shown.black), materials, options);
    oracle::Picture behind = hidden.light;
    for (std::size_t i = 0; i < light.values.size(); ++i) {
      light.values[i] *= whole(seen.weights.values[i], hidden.weight.values[i]);
      behind.values[i] =
          std::clamp(behind.values[i] + hidden.bent.values[i], behind.values[i] / 4, 4 * behind.values[i]);
    }
    const double error_of_hidden = oracle::compare(light, behind, seen.touched).relative_l2;
    largest_effect = std::max(largest_effect, effect);
    CHECK(error < (is_projected ? 0.02 : 0.01));
    // Where hidden surface is far, all of its light may be what comes from beyond the reach: 0.3 % of that of a plane,
    // and more of a projected profile, which is steeper.
    const double hidden_share = norm_of(behind, seen.touched) / norm_of(expected, seen.touched);
    CHECK(error_of_hidden < (is_projected ? 0.04 : 0.025) + (is_projected ? 0.006 : 0.003) / hidden_share);
  }
  CHECK(largest_effect > 0.01);
}

// How much of the profile the passes find on the visible surface shows where that alone is lit, evenly: they scatter
// such light to S w / min(w + W, 1).
TEST_CASE("separable passes and discs join their light with hidden light by their own weights", "[views]") {
  const Method method = GENERATE(Method::separable, Method::disc);
  Random random(40 + static_cast<unsigned>(method));
  const auto subject = static_cast<Subject>(random.integer(0, 2));
  Shown shown(closed_scene(random, subject, random_place(random)));
  const std::vector<dermis::Material> materials =
      random_materials(random, random.coin() ? Crossing::projected : Crossing::distance);
  const Options options{.method = method};
  const auto as_oracle = dermis::oracle::materials_of(materials, options.taps);
  const oracle::Reference exact = oracle::surface_integral(shown.frame, as_oracle, options);
  const oracle::HiddenLight hidden = oracle::hidden_light(shown.frame, as_oracle, options);
  CAPTURE(test_seed(), static_cast<int>(method), static_cast<int>(subject), materials[0].profile.is_projected());

  const oracle::Picture all = scattered(shown.frame, materials, options);
  Shown dark_behind(shown.scene);
  for (std::size_t i = 0; i < dark_behind.views.size(); ++i) {
    std::vector<float>& light = dark_behind.scene.others[i].light;
    std::fill(light.begin(), light.end(), 0.0F);
  }
  oracle::Picture weights = scattered(dark_behind.with_light(dark_behind.white), materials, options);
  Frame front = shown.frame;
  front.views = {};
  const oracle::Picture seen = scattered(front, materials, options);
  front.light.host = shown.white.data();
  const oracle::Picture even = scattered(front, materials, options);
  for (std::size_t i = 0; i < weights.values.size(); ++i) {
    const double part = weights.values[i] / even.values[i];
    const double behind = hidden.weight.values[i];
    weights.values[i] = part + behind >= 1 || behind == 0 ? part : part * behind / (1 - part);
  }
  const double by_own_weights = oracle::compare(all, joined(seen, weights, hidden), exact.touched).relative_l2;
  const double by_exact_weights = oracle::compare(all, joined(seen, exact.weights, hidden), exact.touched).relative_l2;
  const double effect = oracle::compare(seen, all, exact.touched).relative_l2;
  CHECK(effect > 0.01);
  CHECK(by_own_weights < 0.02);
  // What wrong weights misplace is a share of what is hidden: all of it where the passes would find everything. On
  // bodies this small they find some percent too much or too little, which is up to a quarter of it in 82 cases.
  CHECK(by_exact_weights < effect / 2);
}

namespace {

/// A sphere of radius 10 under even light, by parallel rays from the front, and from behind or from two corners there.
ClosedScene parallel_sphere(Random& random, Place place) {
  const Vector front = random_direction(random);
  const Vector back{-front[0], -front[1], -front[2]};
  ClosedScene scene;
  scene.surfaces = {{{0, 0, 0}, {10, 10, 10}, 1}};
  const auto from = [&](const Vector& direction) {
    const Pose pose = pose_from(random, direction, 10, 40, 40, Camera::Projection::orthographic);
    return shoot(pose, scene.surfaces, constant_irradiance(1));
  };
  scene.front = from(front);
  if (place == Place::behind) {
    scene.others = {from(back)};
  } else {
    const Vector corner = turned_away(random, back, random.uniform(0.6, 0.9));
    const double along = 2 * (back[0] * corner[0] + back[1] * corner[1] + back[2] * corner[2]);
    scene.others = {from(corner),
                    from({along * back[0] - corner[0], along * back[1] - corner[1], along * back[2] - corner[2]})};
  }
  return scene;
}

}  // namespace

// Of the surface of a sphere, the part within a chord of length r is pi r^2, so that R sums to the share of light that
// leaves within the diameter. But of a hemisphere that is seen from its top, p pixels in radius, the outermost half
// pixel has the share sqrt(1 / p), a quarter here, of which slopes between pixels show a half.
TEST_CASE("a sphere has its area and the whole of the profile, seen and hidden", "[views]") {
  const Place place = GENERATE(Place::behind, Place::corners);
  Random random(60 + static_cast<unsigned>(place));
  const Shown shown(parallel_sphere(random, place));
  const std::vector<dermis::Material> materials = {
      {1, Profile::burley({random.uniform(1, 4), random.uniform(1, 4), random.uniform(1, 4)})}};
  const Options options{.method = Method::exact};
  const auto as_oracle = dermis::oracle::materials_of(materials, options.taps);
  const oracle::Reference seen = oracle::surface_integral(shown.frame, as_oracle, options);
  const oracle::HiddenLight hidden = oracle::hidden_light(shown.frame, as_oracle, options);
  CAPTURE(test_seed(), static_cast<int>(place));
  const double half = 2 * std::numbers::pi * 100;
  const bool is_whole = place == Place::corners;
  CHECK(hidden.area_mm2[0] > (is_whole ? 0.94 : 0.75) * half);
  CHECK(hidden.area_mm2[0] < 1.06 * half);

  const oracle::Picture all = scattered(shown.frame, materials, options);
  for (int c = 0; c < 3; ++c) {
    double sum = 0, pixels = 0, brightest = 0, darkest = 1;
    for (int y = 0; y < shown.frame.height; ++y) {
      for (int x = 0; x < shown.frame.width; ++x) {
        if (seen.touched(x, y) == 0) continue;
        sum += seen.weights(x, y, c) + hidden.weight(x, y, c);
        pixels += 1;
        brightest = std::max(brightest, all(x, y, c));
        darkest = std::min(darkest, all(x, y, c));
      }
    }
    CHECK(sum / pixels > 0.8 * materials[0].profile.cdf(c, 20));
    CHECK(sum / pixels < 1.03 * materials[0].profile.cdf(c, 20));
    // Even light stays even light, but for the area that is too much.
    CHECK(darkest > 1 - 1e-5);
    CHECK(brightest < 1.05);
  }
}

// Its samples stand for half the area, and R of a sample is blurred by that: up to 1 %.
TEST_CASE("a view that is given twice counts once", "[views]") {
  Random random(70);
  const auto subject = static_cast<Subject>(random.integer(0, 2));
  Shown shown(closed_scene(random, subject, Place::behind));
  const std::vector<dermis::Material> materials =
      random_materials(random, random.coin() ? Crossing::projected : Crossing::distance);
  const Options options{.method = Method::exact};
  const oracle::Picture once = scattered(shown.with_light(shown.black), materials, options);
  shown.views.push_back(shown.views.front());
  shown.frame.views = shown.views;
  const oracle::Picture twice = scattered(shown.with_light(shown.black), materials, options);
  CAPTURE(test_seed(), static_cast<int>(subject), materials[0].profile.is_projected());
  CHECK(oracle::compare(twice, once).relative_l2 < 3e-2);
}
