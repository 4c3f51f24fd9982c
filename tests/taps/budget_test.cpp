// Taps by a tolerance: how many there are, and that what they predict is what the filter does.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "dermis/plan.hpp"
#include "dermis/tap_tables.hpp"
#include "inputs/natural_picture.hpp"
#include "support/catch.hpp"
#include "support/natural_pictures.hpp"
#include "support/random.hpp"
#include "taps/card.hpp"

using dermis::make_tap_set;
using dermis::make_taps;
using dermis::Profile;
using dermis::TapLevel;
using dermis::Taps;
using dermis::TapsDesign;
using dermis::TapSet;
using dermis::with_rank;

namespace {

constexpr int levels_per_octave = 1 << Taps::log2_levels_per_octave;
constexpr int levels_up_to_512_px = 10 * levels_per_octave;  // Wider kernels have the taps of others, spread out.

TapsDesign within(double tolerance, int rank = 0) { return {.rank = rank, .count = 33, .tolerance = tolerance}; }

/// Returns a profile whose channels are up to a factor of 4 apart in width.
Profile random_profile(Random& random) {
  const double mm = std::exp(random.uniform(-3, 3));
  const auto channel = [&] { return mm * random.uniform(0.25, 1); };
  if (random.coin()) return Profile::burley({mm, channel(), channel()});
  const double narrow = random.uniform(0.03, 0.3);
  return Profile::gaussians(
      {{mm * mm, {1, random.uniform(0, 1), random.uniform(0, 1)}}, {narrow * mm * mm, {random.uniform(0, 1), 1, 1}}});
}

int count_of(const TapLevel& level) { return 2 * static_cast<int>(level.offsets_px.size()) + 1; }

int level_for(double radius_px) { return Taps::level_index(static_cast<float>(radius_px)); }

/// Returns the taps of a level on a flat block whose pixels have the size that they were made for.
TapSet set_of(const Taps& taps, const TapLevel& level) {
  const std::size_t pairs = level.offsets_px.size();
  const auto& weights = level.flat_weights[level.flat_weights.size() / 2];
  TapSet set;
  set.pixel_mm = 1 / static_cast<double>(level.px_per_mm);
  for (std::size_t i = pairs; i > 0; --i) set.offsets_px.push_back(-level.offsets_px[i - 1]);
  for (std::size_t i = 0; i <= pairs; ++i) set.offsets_px.push_back(i == 0 ? 0 : level.offsets_px[i - 1]);
  for (std::size_t t = 0; t < taps.terms.size(); ++t) {
    dermis::TapTerm term;
    for (int c = 0; c < 3; ++c) term.scale[c] = static_cast<double>(taps.terms[t].scale[c]);
    for (std::size_t at = 0; at <= 2 * pairs; ++at) {
      const std::size_t row = at < pairs ? pairs - at : at - pairs;
      term.weights.push_back(weights[row * taps.terms.size() + t]);
    }
    set.terms.push_back(term);
  }
  return set;
}

/// Returns the convolution of a card with the profile on pixels, every `step` pixels and `margin_px` from the edges.
/// The margin bounds the kernel; what lies beyond is made up for by the rest.
std::vector<double> convolved(const Card& card, const Profile& profile, int c, int margin_px, int step) {
  const double mm = 1 / card.px_per_mm;
  const int reach_px = margin_px;
  std::vector<double> kernel(static_cast<std::size_t>(reach_px + 1) * (reach_px + 1));
  for (int y = 0; y <= reach_px; ++y) {
    for (int x = 0; x <= y; ++x) {
      kernel[static_cast<std::size_t>(y) * (reach_px + 1) + x] =
          kernel[static_cast<std::size_t>(x) * (reach_px + 1) + y] =
              profile.rectangle(c, (x - 0.5) * mm, (x + 0.5) * mm, (y - 0.5) * mm, (y + 0.5) * mm);
    }
  }
  std::vector<double> result;
  for (int y = margin_px; y < card.height - margin_px; y += step) {
    for (int x = margin_px; x < card.width - margin_px; x += step) {
      double sum = 0;
      double weights = 0;
      for (int j = -reach_px; j <= reach_px; ++j) {
        const double* row = &kernel[static_cast<std::size_t>(std::abs(j)) * (reach_px + 1)];
        for (int i = -reach_px; i <= reach_px; ++i) {
          sum += row[std::abs(i)] * card.at(x + i, y + j);
          weights += row[std::abs(i)];
        }
      }
      result.push_back(sum / weights);
    }
  }
  return result;
}

}  // namespace

TEST_CASE("taps are fewer for narrow kernels and for loose tolerances", "[budget]") {
  Random random(900);
  for (int round = 0; round < 3; ++round) {
    const Profile profile = random_profile(random);
    const int rank = random.integer(1, 2);
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (const double tolerance : {0.002, 0.02, 0.05}) {
      CAPTURE(test_seed(), round, rank, tolerance);
      const Taps taps = make_taps(profile, within(tolerance, rank));
      REQUIRE(static_cast<int>(taps.terms.size()) == rank);
      REQUIRE(taps.levels.size() == static_cast<std::size_t>(Taps::octaves * levels_per_octave));
      std::size_t pairs = 0;
      for (std::size_t i = 0; i < levels_up_to_512_px; ++i) {
        CAPTURE(i);
        REQUIRE(count_of(taps.levels[i]) <= 33);
        REQUIRE((i == 0 || taps.levels[i].offsets_px.size() >= taps.levels[i - 1].offsets_px.size()));
        pairs += taps.levels[i].offsets_px.size();
      }
      CHECK(count_of(taps.levels[level_for(8)]) < count_of(taps.levels[levels_up_to_512_px - 1]));
      CHECK(pairs < before);
      before = pairs;
    }
  }
}

TEST_CASE("a level has no more taps than the tolerance takes, and meets it", "[budget]") {
  Random random(901);
  constexpr int side_px = 512;
  const NaturalPictures pictures(side_px, 3, test_seed());
  for (int round = 0; round < 3; ++round) {
    const Profile profile = random_profile(random);
    const double radius_px = std::exp(random.uniform(std::log(8.0), std::log(60.0)));
    const double tolerance = std::exp(random.uniform(std::log(0.006), std::log(0.05)));
    const TapsDesign design = with_rank(profile, within(tolerance));
    const Taps taps = make_taps(profile, design);
    const TapLevel& level = taps.levels[level_for(radius_px)];
    const TapSet set = set_of(taps, level);
    const double error = ExactKernel(profile, set.pixel_mm, side_px).rel_l2(set, pictures);
    CAPTURE(test_seed(), round, radius_px, tolerance, design.rank, count_of(level), error);
    // Predictions are within a factor of 1.5 of the error on random pictures (see accuracy_test.cpp), and the levels of
    // a quarter of an octave have the taps that the widest of them needs.
    CHECK(error <= 1.5 * tolerance);
    // The levels of this count began where fewer were not enough for the widest of a group of four levels.
    auto first = static_cast<std::size_t>(level_for(radius_px));
    while (first > 0 && count_of(taps.levels[first - 1]) == count_of(level)) --first;
    const std::vector<int>& offsets_px = taps.levels[first].offsets_px;
    if (offsets_px.back() == static_cast<int>(offsets_px.size())) continue;  // Taps lie on every pixel.
    TapsDesign fewer = design;
    fewer.tolerance = 0;
    fewer.count = count_of(taps.levels[first - 1]);
    const double pixel_mm = 1 / static_cast<double>(taps.levels[first + 3].px_per_mm);
    CHECK(make_tap_set(profile, fewer, pixel_mm).predicted_rel_l2 > tolerance);
  }
}

TEST_CASE("the filter is as far off on a plane as a tolerance predicts, and within it", "[budget]") {
  const dermis::Device device = dermis::Device::open();
  Random random(902);
  constexpr int side_px = 256;
  for (int round = 0; round < 2; ++round) {
    const Profile profile = random_profile(random);
    const double radius_px = random.uniform(12, 24);
    const double px_per_mm = radius_px / profile.half_width(profile.widest_channel(), 0.999);
    const Card card{side_px, side_px, px_per_mm,
                    dermis::bench::natural_picture(side_px, test_seed() + 7 + static_cast<unsigned>(round))};
    // Beyond twice the radius lie some ten thousandths of the light.
    const int margin_px = 2 * static_cast<int>(radius_px);
    constexpr int step = 5;  // The error is smooth, so that neighbours tell nothing new.
    std::array<std::vector<double>, 3> exact;
    for (int c = 0; c < 3; ++c) exact[c] = convolved(card, profile, c, margin_px, step);
    int reads_before = std::numeric_limits<int>::max();
    for (const double tolerance : {0.006, 0.02, 0.06}) {
      const TapsDesign design = with_rank(profile, within(tolerance), 1 / px_per_mm);
      const Taps taps = make_taps(profile, design);
      TapsDesign there = design;
      there.tolerance = 0;
      there.count = count_of(taps.levels[level_for(taps.radius_mm * px_per_mm)]);
      const double predicted = make_tap_set(profile, there, 1 / px_per_mm).predicted_rel_l2;
      const std::vector<float> scattered = card.filtered(device, profile, {.taps = design});
      double errors = 0;
      double truths = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        std::size_t at = 0;
        for (int y = margin_px; y < side_px - margin_px; y += step) {
          for (int x = margin_px; x < side_px - margin_px; x += step) {
            const double value = scattered[(static_cast<std::size_t>(y) * side_px + x) * 3 + c];
            errors += std::pow(value - exact[c][at], 2);
            truths += std::pow(exact[c][at], 2);
            ++at;
          }
        }
      }
      const double error = std::sqrt(errors / truths);
      CAPTURE(test_seed(), round, radius_px, tolerance, design.rank, there.count, predicted, error);
      CHECK(predicted <= tolerance);
      // Random pictures as a whole are within a factor of 1.5 (accuracy_test.cpp). This is a part of one: it holds
      // about (160 px / kernel width)^2 >= 40 patches whose errors do not depend on each other, so that their sum of
      // squares has a standard deviation of sqrt(2 / 40) = 0.22 of itself, and the root of it, three times out, is off
      // by a factor of sqrt(1 + 3 * 0.22) = 1.3. Together they make 2. The sizes of two levels differ by a thousandth.
      CHECK(error <= 2 * predicted + 1e-3);
      CHECK(error >= predicted / 2 - 1e-3);
      CHECK(error <= 2 * tolerance);
      const int reads = (1 + design.rank) * there.count;
      CHECK(reads <= reads_before);
      reads_before = reads;
    }
  }
}

TEST_CASE("a rank that is left open is the lowest that leaves the taps their share", "[budget]") {
  const Profile skin = dermis::preset("skin").profile;
  CHECK(with_rank(skin, within(0.2)).rank == 1);
  CHECK(with_rank(skin, within(0.006)).rank == 2);
  CHECK(with_rank(skin, within(1e-4)).rank == 3);
  CHECK(with_rank(skin, within(0.2, 2)) == within(0.2, 2));
  TapsDesign guided = within(0.001);
  guided.model = dermis::Model::guided;
  CHECK(with_rank(skin, guided).rank == 1);
  // Kernels of few pixels are more nearly separable.
  Random random(903);
  const Profile profile = random_profile(random);
  const double radius_mm = profile.half_width(profile.widest_channel(), 0.999);
  const TapsDesign fine = with_rank(profile, within(0.01), radius_mm / 64);
  const TapsDesign coarse = with_rank(profile, within(0.01), radius_mm / 2);
  CHECK(coarse.rank <= fine.rank);
  CHECK(coarse.rank == 1);
}

TEST_CASE("a plan takes a design whose rank is left open", "[budget]") {
  const dermis::Device device = dermis::Device::open();
  Random random(904);
  const Profile profile = random_profile(random);
  Card card{40, 40, 10 / profile.half_width(profile.widest_channel(), 0.999), {}};
  for (int i = 0; i < 40 * 40; ++i) card.light.push_back(random.uniform(0, 1));
  const TapsDesign open = within(std::exp(random.uniform(std::log(0.003), std::log(0.1))));
  const TapsDesign resolved = with_rank(profile, open);
  CAPTURE(test_seed(), open.tolerance, resolved.rank);
  REQUIRE(resolved.rank > 0);
  CHECK(card.filtered(device, profile, {.taps = open}) == card.filtered(device, profile, {.taps = resolved}));
  TapsDesign other = resolved;
  other.rank = resolved.rank == 1 ? 2 : 1;
  CHECK(card.filtered(device, profile, {.taps = open}) != card.filtered(device, profile, {.taps = other}));
}

TEST_CASE("a tolerance out of range is refused, and so is an open rank without one", "[budget]") {
  const Profile profile = dermis::preset("skin").profile;
  for (const double tolerance : {-0.1, 1.0, std::nan("")}) {
    CHECK_THROWS_WITH(make_taps(profile, within(tolerance, 2)), Catch::Contains("tolerance: got"));
    CHECK_THROWS_WITH(make_tap_set(profile, within(tolerance, 2), 1), Catch::Contains("at least 0 and below 1"));
  }
  CHECK_THROWS_WITH(make_taps(profile, within(0)), "rank: got 0, want 1..3 for this model");
  CHECK_THROWS_WITH(with_rank(profile, within(0.1), -1), Catch::Contains("pixel_mm: got -1"));
}
