#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/tap_tables.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "taps/prediction/lattice_waves.hpp"
#include "taps/tables/surface_weights.hpp"
#include "taps/tap_budget.hpp"

using dermis::make_taps;
using dermis::Model;
using dermis::Placement;
using dermis::Profile;
using dermis::TapLevel;
using dermis::Taps;
using dermis::TapsDesign;

namespace {

/// Returns the weight of the centre (row 0) or a pair of a level on a surface where lengths and distances are longer
/// than on the plane of the level by these factors, as a pass computes it on a curved block.
double curved_weight(const Taps& taps, const TapLevel& level, std::size_t row, std::size_t term, int c, double length,
                     double distance) {
  if (row == 0 && !taps.terms[term].normalised) return 0;
  const double px_per_mm = level.px_per_mm;
  const auto& [scale, softening, end] = level.nearness[row];
  const auto& [a, b, k] = level.weights[row * taps.terms.size() + term];
  const double r_mm = row == 0 ? 0 : distance * level.offsets_px[row - 1] / px_per_mm;
  const double at = row == 0 ? length / px_per_mm : r_mm * r_mm;
  const double t = std::max(scale / (at + static_cast<double>(softening)) - static_cast<double>(end), 0.0);
  const double cubic = t * (a[c] + t * (b[c] + t * static_cast<double>(k[c])));
  if (row == 0) return std::max(1 - cubic, static_cast<double>(dermis::least_centre_weight));
  return length / px_per_mm * cubic;
}

/// Returns the weights of one level on a plane parallel to the screen: the centre's, then the pairs'.
std::vector<double> weights_of(const Taps& taps, const TapLevel& level, std::size_t term, int c) {
  std::vector<double> weights;
  for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
    weights.push_back(curved_weight(taps, level, row, term, c, 1, 1));
  }
  return weights;
}

double sum_of(const std::vector<double>& weights) {
  return 2 * std::accumulate(weights.begin() + 1, weights.end(), weights[0]) - weights[0];
}

constexpr TapsDesign by_importance(int count) {
  return {.model = Model::pre_integrated, .count = count, .placement = Placement::importance};
}

const TapsDesign some_designs[] = {
    by_importance(3),
    by_importance(25),
    by_importance(127),
    {.model = Model::pre_integrated, .count = 15, .placement = Placement::uniform},
    {.model = Model::pre_integrated, .count = 9, .placement = Placement::quadratic},
    {.model = Model::artist, .count = 17},
    {.model = Model::guided, .count = 11, .guide = 4},
    {.model = Model::svd, .rank = 3, .count = 25},
    {.model = Model::gaussians, .rank = 4, .count = 25},
    {.model = Model::optimised, .count = 7, .placement = Placement::optimised},
    {.model = Model::optimised, .rank = 2, .count = 17, .placement = Placement::optimised},
    {.model = Model::optimised, .rank = 3, .count = 25, .placement = Placement::optimised, .non_negative = true},
};

}  // namespace

TEST_CASE("every level holds all light in sorted, distinct whole-pixel taps", "[taps]") {
  Random random(200);
  const double d = std::exp(random.uniform(-10, 10));
  // At this width the narrowest Gaussian rounds to a little less than 0 at a far tap.
  constexpr double vanishing = 0.0099031244;
  for (const Profile& profile : {dermis::preset("skin").profile, Profile::burley({d, d / 2, d / 5}),
                                 Profile::burley({vanishing, vanishing / 2, vanishing / 5})}) {
    for (const TapsDesign& design : some_designs) {
      const Taps taps = make_taps(profile, design);
      CAPTURE(test_seed(), d, static_cast<int>(design.model), design.rank, design.count);
      REQUIRE(static_cast<int>(taps.terms.size()) == design.rank);
      CHECK(taps.terms[0].normalised);
      for (int c = 0; c < 3; ++c) {
        // Constant light stays constant, as terms that are not normalised keep their sum, whatever the taps.
        double kept = 0;
        for (const dermis::Term& term : taps.terms) {
          const double sum = term.normalised ? 1 : static_cast<double>(term.sum[c]);
          kept += static_cast<double>(term.scale[c]) * sum * sum;
        }
        CHECK(kept == Approx(1).epsilon(1e-5));
      }
      for (const TapLevel& level : taps.levels) {
        CAPTURE(level.px_per_mm * taps.radius_mm);
        REQUIRE(static_cast<int>(level.offsets_px.size()) <= design.count / 2);
        REQUIRE(level.nearness.size() == level.offsets_px.size() + 1);
        REQUIRE(level.weights.size() == level.nearness.size() * taps.terms.size());
        int previous = 0;
        for (const int offset_px : level.offsets_px) {
          REQUIRE(offset_px > previous);
          previous = offset_px;
        }
        for (std::size_t t = 0; t < taps.terms.size(); ++t) {
          for (int c = 0; c < 3; ++c) {
            const std::vector<double> weights = weights_of(taps, level, t, c);
            for (const double weight : weights) REQUIRE(std::isfinite(weight));
            if (!taps.terms[t].normalised) continue;
            for (const double weight : weights) REQUIRE(weight >= -1e-6);
            // A tap that lies where the tables of a narrow channel know of no light loses the light of its run, and
            // the narrowest of several Gaussians may have all of it there; a pass divides by the sum.
            REQUIRE(sum_of(weights) < 1 + 5e-3);
            if (design.model != Model::gaussians) REQUIRE(sum_of(weights) > 1 - 0.03);
          }
        }
      }
    }
  }
}

TEST_CASE("on a plane the passes weigh as the tap set does", "[taps]") {
  const Profile profile = dermis::preset("marble").profile;
  for (const TapsDesign& design : some_designs) {
    const Taps taps = make_taps(profile, design);
    for (const float radius_px : {5.3F, 31.0F, 90.0F}) {
      const TapLevel& level = taps.levels[Taps::level_index(radius_px)];
      const dermis::TapSet set = dermis::make_tap_set(profile, design, 1 / static_cast<double>(level.px_per_mm));
      // Levels start the search for taps at those of the next level, so that only taps without a search are the same.
      if (design.placement == Placement::optimised && radius_px > static_cast<float>(design.count / 2)) continue;
      const auto middle = static_cast<int>(set.offsets_px.size()) / 2;
      CAPTURE(static_cast<int>(design.model), design.count, radius_px);
      REQUIRE(static_cast<int>(level.offsets_px.size()) == middle);
      for (int c = 0; c < 3; ++c) {
        const std::vector<double> weights = weights_of(taps, level, 0, c);
        for (int i = 0; i <= middle; ++i) {
          // Weights are rounded to float32 in the level; those at which a narrow term has vanished are left out.
          CHECK(set.terms[0].weights[middle + i][c] == Approx(weights[i]).margin(1e-5));
          if (i > 0) CHECK(set.offsets_px[middle + i] == level.offsets_px[i - 1]);
        }
      }
    }
  }
}

TEST_CASE("a kernel that the taps can cover has one tap per pixel", "[taps]") {
  const Profile profile = dermis::preset("marble").profile;
  const Taps taps = make_taps(profile, by_importance(25));
  const TapLevel& level = taps.levels[Taps::level_index(11)];
  REQUIRE(level.offsets_px.size() == 11);
  const std::vector<double> weights = weights_of(taps, level, 0, 0);
  for (int i = 0; i < 10; ++i) {
    REQUIRE(level.offsets_px[i] == i + 1);
    const double px_per_mm = level.px_per_mm;
    const double begin = (i + 0.5) / px_per_mm;
    const double end = (i + 1.5) / px_per_mm;
    CHECK(weights[i + 1] == Approx(profile.edge_tail(0, begin) - profile.edge_tail(0, end)).epsilon(1e-5));
  }
}

TEST_CASE("levels divide octaves in sixteen", "[taps]") {
  CHECK(Taps::level_index(0.49F) == -1);
  CHECK(Taps::level_index(std::numeric_limits<float>::quiet_NaN()) == -1);
  CHECK(Taps::level_index(0.5F) == 0);
  CHECK(Taps::level_index(1.0F) == 16);
  CHECK(Taps::level_index(1.0625F) == 17);
  CHECK(Taps::level_index(std::numeric_limits<float>::infinity()) == Taps::octaves * 16 - 1);
  const Taps taps = make_taps(dermis::preset("wax").profile, by_importance(7));
  for (const float radius_px : {0.6F, 3.3F, 100.0F, 9000.0F}) {
    const TapLevel& level = taps.levels[Taps::level_index(radius_px)];
    CHECK(level.px_per_mm * taps.radius_mm == Approx(radius_px).epsilon(1.0 / 32));
  }
}

TEST_CASE("the curves of a term follow the profile", "[taps]") {
  for (const dermis::Preset& preset : dermis::presets()) {
    const dermis::DesignedTaps designed(preset.profile, by_importance(5));
    const double radius_mm = designed.radius_mm();
    const dermis::TermCurves curves = dermis::make_term_curves(preset.profile, designed.model()[0], radius_mm);
    CAPTURE(preset.name);
    for (int c = 0; c < 3; ++c) {
      for (double share = 0.02; share < 0.99; share += 0.0371) {
        const double x = preset.profile.half_width(c, share);
        // The octaves of the falloff reach to a hundredth of the widest channel's radius, those of the centre to a
        // thousandth and less.
        if (x > radius_mm / 60) {
          CHECK(dermis::value_at(curves.falloff, c, x) == Approx(preset.profile.marginal(c, x)).epsilon(1.5e-2));
        }
        if (x > radius_mm / 2000) {
          CHECK(dermis::value_at(curves.centre, c, std::sqrt(x)) == Approx(share).epsilon(4e-3));
        }
      }
    }
  }
}

TEST_CASE("evenly spaced frequencies give the responses that others give", "[taps]") {
  Random random(202);
  for (const int count : {129, 257, 1025}) {
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(count, 0, std::acos(-1.0));
    const dermis::LatticeWaves evenly_spaced(u, true);
    const dermis::LatticeWaves any(u);
    std::vector<dermis::Gaussian> gaussians;
    for (int i = 0; i < 40; ++i) gaussians.push_back({std::exp(random.uniform(-4, 14)), 1});
    const Eigen::MatrixXd wanted = any.of_gaussians(gaussians, 1);
    CAPTURE(test_seed(), count);
    CHECK(wanted.row(0).isOnes(1e-6));
    CHECK(wanted.maxCoeff() <= 1 + 1e-9);
    // Values of a recurrence over up to 1.2 periods have as many roundings squared: 6e6 of 1e-16.
    CHECK((evenly_spaced.of_gaussians(gaussians, 1) - wanted).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("on a tilted plane the weights by distance are those of the profile", "[taps]") {
  // How far weights may be off in all, for 1 / the cosine of the tilt. Measured: 0.0002, 0.011, 0.031, 0.075.
  constexpr std::array bounds = {std::pair{1.0, 1e-3}, std::pair{1.2, 0.02}, std::pair{1.6, 0.04}, std::pair{2.5, 0.1}};
  for (const char* name : {"skin", "marble", "wax"}) {
    const Profile profile = dermis::preset(name).profile;
    for (const int rank : {1, 2}) {
      // Placed without a search, which would start from other levels.
      const TapsDesign design{.model = Model::optimised, .rank = rank, .count = 17, .placement = Placement::importance};
      const Taps taps = make_taps(profile, design);
      const dermis::DesignedTaps designed(profile, design);
      std::vector<dermis::TermCurves> curves;
      for (const auto& term : designed.model()) {
        curves.push_back(dermis::make_term_curves(profile, term, designed.radius_mm()));
      }
      for (const float radius_px : {5.3F, 31.0F, 90.0F}) {
        const TapLevel& level = taps.levels[Taps::level_index(radius_px)];
        dermis::TapBudget budget(profile, design);
        const dermis::SizedTaps sized = budget.at(Taps::level_index(radius_px));
        REQUIRE(sized.placed.offsets_px.size() == level.offsets_px.size());
        const dermis::SurfaceWeights exact(sized, curves, level.px_per_mm);
        for (const auto& [tilt, bound] : bounds) {
          const std::size_t functions = exact.functions();
          std::vector<double> wanted(exact.rows() * functions);
          for (std::size_t row = 0; row < exact.rows(); ++row) {
            exact.on_surface(row, tilt, tilt, &wanted[row * functions]);
          }
          for (std::size_t t = 0; t < taps.terms.size(); ++t) {
            for (int c = 0; c < 3; ++c) {
              double off = 0;
              for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
                if (row == 0 && !taps.terms[t].normalised) continue;
                const double its = wanted[row * functions + 3 * t + static_cast<std::size_t>(c)];
                off += (row == 0 ? 1 : 2) * std::abs(curved_weight(taps, level, row, t, c, tilt, tilt) - its);
              }
              CAPTURE(name, rank, radius_px, tilt, t, c);
              CHECK(off < bound);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("no distance makes a weight of a mean negative", "[taps]") {
  Random random(201);
  for (const TapsDesign& design : some_designs) {
    const Taps taps = make_taps(dermis::preset("skin").profile, design);
    for (const TapLevel& level : taps.levels) {
      for (std::size_t row = 0; row <= level.offsets_px.size(); ++row) {
        const double longer = std::exp(random.uniform(-6, 6));
        for (int c = 0; c < 3; ++c) {
          const double on_plane = curved_weight(taps, level, row, 0, c, 1, 1);
          // Coefficients are rounded to float32, and those of one weight differ in sign.
          REQUIRE(curved_weight(taps, level, row, 0, c, row == 0 ? longer : 1, longer) >= -1e-4 * on_plane - 1e-9);
        }
      }
    }
  }
}

TEST_CASE("a bad number of taps is refused", "[taps]") {
  const Profile profile = dermis::preset("skin").profile;
  for (const int count : {-1, 0, 1, 4, 128, 2049}) {
    CHECK_THROWS_WITH(make_taps(profile, {.count = count}),
                      "taps: got " + std::to_string(count) + ", want an odd number, 3..2047");
  }
}

TEST_CASE("the cheapest design meets its tolerance", "[taps]") {
  const Profile profile = dermis::preset("skin").profile;
  const double pixel_mm = 0.15;
  double reads = 0;
  for (const double tolerance : {0.05, 0.015, 0.004}) {
    const auto design = dermis::cheapest_design(profile, tolerance, pixel_mm);
    CAPTURE(tolerance);
    REQUIRE(design);
    CHECK(dermis::make_tap_set(profile, *design, pixel_mm).predicted_rel_l2 <= tolerance);
    CHECK((1 + design->rank) * design->count >= reads);
    reads = (1 + design->rank) * design->count;
  }
  CHECK(reads > 40);
  CHECK_FALSE(dermis::cheapest_design(profile, 1e-6, pixel_mm));
  CHECK_THROWS_WITH(dermis::cheapest_design(profile, 0, pixel_mm), Catch::Contains("tolerance"));
}
