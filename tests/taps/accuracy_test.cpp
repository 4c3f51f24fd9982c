// How far taps are from the exact convolution on pictures with the statistics of natural images, and how well they
// predict it. W is the width of the kernel: the standard deviation of the widest Gaussian of the skin preset, that of
// the widest channel along an axis (sqrt(7) d) of Burley's profile.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "dermis/taps.hpp"
#include "support/catch.hpp"
#include "support/natural_pictures.hpp"
#include "support/random.hpp"

using dermis::Fetch;
using dermis::make_tap_set;
using dermis::Model;
using dermis::Placement;
using dermis::Profile;
using dermis::TapsDesign;
using dermis::TapSet;

namespace {

const Profile skin = dermis::preset("skin").profile;
const double skin_width_mm = std::sqrt(7.41);
const Profile burley = Profile::burley({1, 0.6, 0.35});
const double burley_width_mm = std::sqrt(7.0);

constexpr TapsDesign fitted(int rank, int count) {
  return {.model = Model::optimised, .rank = rank, .count = count, .placement = Placement::optimised};
}

constexpr int dense = 2047;

struct Row {
  const Profile& profile;
  double width_px;
  TapsDesign design;
  Fetch fetch;
  double bound;
};

/// Makes each kernel once.
const ExactKernel& exact_kernel(const Profile& profile, double width_px) {
  static std::map<std::pair<const Profile*, double>, ExactKernel> kernels;
  const bool is_skin = &profile == &skin;
  const double pixel_mm = (is_skin ? skin_width_mm : burley_width_mm) / width_px;
  return kernels.try_emplace({&profile, width_px}, profile, pixel_mm, 1024).first->second;
}

const NaturalPictures& pictures() {
  static const NaturalPictures all(1024, 3, test_seed());
  return all;
}

double pixel_mm(const Profile& profile, double width_px) {
  return (&profile == &skin ? skin_width_mm : burley_width_mm) / width_px;
}

}  // namespace

TEST_CASE("taps are as good as they should be on natural images", "[accuracy]") {
  // The bounds are the published figures for the same tables, rounded up by a tenth or two.
  const Row rows[] = {
      {skin, 4, fitted(2, dense), Fetch::integer, .003},     {skin, 16, fitted(2, dense), Fetch::integer, .003},
      {skin, 64, fitted(2, dense), Fetch::integer, .003},    {skin, 120, fitted(2, dense), Fetch::integer, .003},
      {burley, 4, fitted(2, dense), Fetch::integer, .006},   {burley, 32, fitted(2, dense), Fetch::integer, .006},
      {skin, 4, fitted(3, dense), Fetch::integer, .0006},    {skin, 16, fitted(3, dense), Fetch::integer, .0006},
      {skin, 120, fitted(3, dense), Fetch::integer, .0006},  {burley, 8, fitted(3, dense), Fetch::integer, .0015},
      {burley, 32, fitted(3, dense), Fetch::integer, .0015}, {skin, 16, fitted(1, 7), Fetch::linear, .024},
      {skin, 32, fitted(1, 7), Fetch::linear, .032},         {skin, 8, fitted(1, 17), Fetch::linear, .015},
      {skin, 16, fitted(1, 17), Fetch::linear, .015},        {skin, 32, fitted(1, 17), Fetch::linear, .015},
      {skin, 64, fitted(1, 17), Fetch::linear, .019},        {burley, 16, fitted(1, 17), Fetch::linear, .019},
      {burley, 32, fitted(1, 17), Fetch::linear, .024},      {skin, 16, fitted(2, 17), Fetch::linear, .004},
      {skin, 32, fitted(2, 17), Fetch::linear, .006},        {skin, 64, fitted(2, 17), Fetch::linear, .010},
      {burley, 16, fitted(2, 17), Fetch::linear, .008},      {burley, 32, fitted(2, 17), Fetch::linear, .013},
      {skin, 16, fitted(2, 17), Fetch::integer, .006},       {skin, 32, fitted(2, 17), Fetch::integer, .011},
  };
  for (const Row& row : rows) {
    const TapSet taps = make_tap_set(row.profile, row.design, pixel_mm(row.profile, row.width_px), row.fetch);
    const double error = exact_kernel(row.profile, row.width_px).rel_l2(taps, pictures());
    CAPTURE(test_seed(), &row.profile == &skin, row.width_px, row.design.rank, row.design.count,
            row.fetch == Fetch::linear);
    CHECK(error <= row.bound);
    CHECK(error > row.bound / 20);
  }
}

TEST_CASE("every tap set knows its error", "[accuracy]") {
  std::vector<TapsDesign> designs;
  for (const int count : {5, 9, 17, 33}) {
    designs.push_back(fitted(1, count));
    designs.push_back(fitted(2, count));
    designs.push_back(fitted(3, count));
    for (const Placement placement : {Placement::uniform, Placement::importance, Placement::quadratic}) {
      designs.push_back({.model = Model::pre_integrated, .count = count, .placement = placement});
    }
    for (const Model model : {Model::pre_integrated, Model::artist, Model::guided}) {
      designs.push_back({.model = model, .count = count, .placement = Placement::optimised});
    }
    for (const int rank : {1, 2, 4, 6}) {
      designs.push_back({.model = Model::svd, .rank = rank, .count = count, .placement = Placement::optimised});
      designs.push_back({.model = Model::gaussians, .rank = rank, .count = count, .placement = Placement::optimised});
    }
  }
  Random random(700);
  for (const double width_px : {8.0, 16.0, 32.0, 64.0}) {
    for (const Profile* profile : {&skin, &burley}) {
      for (const TapsDesign& design : designs) {
        if (random.integer(0, 2) > 0) continue;  // Each run tests another third of them.
        const Fetch fetch = random.coin() ? Fetch::linear : Fetch::integer;
        const TapSet taps = make_tap_set(*profile, design, pixel_mm(*profile, width_px), fetch);
        const double error = exact_kernel(*profile, width_px).rel_l2(taps, pictures());
        CAPTURE(test_seed(), profile == &skin, width_px, static_cast<int>(design.model), design.rank, design.count,
                static_cast<int>(design.placement), fetch == Fetch::linear, error);
        CHECK(taps.predicted_rel_l2 <= error * 1.5);
        CHECK(taps.predicted_rel_l2 >= error / 1.5);
      }
    }
  }
}

TEST_CASE("weights add up exactly, at sorted, symmetric offsets", "[accuracy]") {
  Random random(701);
  for (int round = 0; round < 24; ++round) {
    const double scale = std::exp(random.uniform(std::log(1e-6), std::log(1e6)));
    const Profile profile = random.coin()
                                ? Profile::burley({scale, scale * random.uniform(0.05, 1), scale / 7})
                                : Profile::gaussians({{scale * scale, {1, 2, 3}}, {scale * scale / 90, {4, 1, 1}}});
    const auto model = static_cast<Model>(random.integer(0, 5));
    TapsDesign design{.model = model,
                      .count = 2 * random.integer(1, 20) + 1,
                      .placement = static_cast<Placement>(random.integer(0, 3)),
                      .non_negative = random.coin()};
    if (model == Model::svd || model == Model::gaussians) design.rank = random.integer(1, 6);
    if (model == Model::optimised) design.rank = random.integer(1, 3);
    const double pixel = scale * std::exp(random.uniform(-4, 2));
    const TapSet taps = make_tap_set(profile, design, pixel, random.coin() ? Fetch::linear : Fetch::integer);
    CAPTURE(test_seed(), round, scale, static_cast<int>(model), design.rank, design.count, pixel);
    REQUIRE(std::isfinite(taps.predicted_rel_l2));
    REQUIRE(std::is_sorted(taps.offsets_px.begin(), taps.offsets_px.end()));
    const std::size_t count = taps.offsets_px.size();
    REQUIRE(static_cast<int>(count) <= design.count);
    for (std::size_t i = 0; i < count; ++i) REQUIRE(taps.offsets_px[i] == -taps.offsets_px[count - 1 - i]);
    for (std::size_t t = 0; t < taps.terms.size(); ++t) {
      for (int c = 0; c < 3; ++c) {
        float forward = 0;
        float backward = 0;
        for (std::size_t i = 0; i < count; ++i) {
          const float weight = taps.terms[t].weights[i][c];
          REQUIRE(std::isfinite(weight));
          REQUIRE(weight == taps.terms[t].weights[count - 1 - i][c]);
          if (design.rank == 1) REQUIRE(weight >= 0);
          forward += weight;
          backward += taps.terms[t].weights[count - 1 - i][c];
        }
        REQUIRE(forward == backward);
        if (t == 0 || model == Model::gaussians) REQUIRE(forward == 1);
        if (t > 0 && model == Model::optimised) REQUIRE(forward == 0);
        REQUIRE(std::isfinite(taps.terms[t].scale[c]));
      }
    }
  }
}

TEST_CASE("a tilted edge, and light below zero", "[accuracy]") {
  struct Case {
    const Profile& profile;
    bool non_negative;
    double edge_bound;      // of the largest error at an edge at 30 degrees, of its height
    double negative_bound;  // of the light that the kernel takes away somewhere
  };
  // Without the floor light may be negative; with it edges are a little less straight.
  for (const Case& what : {Case{skin, false, .005, .02}, Case{burley, false, .005, .04}, Case{skin, true, .01, .003},
                           Case{burley, true, .01, .008}}) {
    constexpr double width_px = 16;
    const double pixel = pixel_mm(what.profile, width_px);
    TapsDesign design = fitted(2, dense);
    design.non_negative = what.non_negative;
    const TapSet taps = make_tap_set(what.profile, design, pixel);
    const auto half = static_cast<int>(taps.offsets_px.size()) / 2;
    for (int c = 0; c < 3; ++c) {
      // The kernels are summed over pixels of equal distance from the edge, as shares of the light beyond it.
      constexpr int reach_px = 100;
      std::vector<double> exact(2 * reach_px + 1);
      std::vector<double> approximate(2 * reach_px + 1);
      double negative = 0;
      for (int y = -half; y <= half; ++y) {
        for (int x = -half; x <= half; ++x) {
          double light = 0;
          for (const dermis::TapTerm& term : taps.terms) {
            light += term.scale[c] * static_cast<double>(term.weights[half + x][c]) *
                     static_cast<double>(term.weights[half + y][c]);
          }
          negative -= std::min(light, 0.0);
          const double truth =
              what.profile.rectangle(c, (x - 0.5) * pixel, (x + 0.5) * pixel, (y - 0.5) * pixel, (y + 0.5) * pixel);
          const double distance_px = x * std::cos(std::acos(-1.0) / 6) + y * std::sin(std::acos(-1.0) / 6);
          const int at = std::clamp(static_cast<int>(std::lround(distance_px)), -reach_px, reach_px) + reach_px;
          exact[at] += truth;
          approximate[at] += light;
        }
      }
      double worst = 0;
      double difference = 0;
      for (int i = 0; i <= 2 * reach_px; ++i) {
        difference += approximate[i] - exact[i];
        worst = std::max(worst, std::abs(difference));
      }
      CAPTURE(&what.profile == &skin, what.non_negative, c);
      CHECK(worst <= what.edge_bound);
      CHECK(negative <= what.negative_bound);
    }
  }
}
