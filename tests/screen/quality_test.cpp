// Options::quality and tolerance: which taps they choose, and that a plan is that of the choice.
#include <string>
#include <vector>

#include "dermis/dermis.hpp"
#include "support/catch.hpp"
#include "support/failure.hpp"
#include "support/random.hpp"

using dermis::choose_taps;
using dermis::Device;
using dermis::Material;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Quality;
using dermis::TapsDesign;

namespace {

/// A card with an edge of light at a random place.
struct Card {
  static constexpr int width = 48;
  static constexpr int height = 20;
  double px_per_mm;
  std::vector<float> light = std::vector<float>(3 * width * height, 0.1F);

  Card(Random& random, double its_px_per_mm) : px_per_mm(its_px_per_mm) {
    const int edge = random.integer(10, 38);
    for (int y = 0; y < height; ++y)
      for (int i = 3 * edge; i < 3 * width; ++i) light[3 * width * y + i] = 1;
  }

  dermis::Frame frame(std::vector<float>& scattered) const {
    scattered.assign(light.size(), 0);
    return {.width = width,
            .height = height,
            .light = {.host = light.data()},
            .camera = dermis::Camera::orthographic(px_per_mm, px_per_mm),
            .scattered = {.host = scattered.data()}};
  }

  std::vector<float> by(const Plan& plan) const {
    std::vector<float> scattered;
    plan.run(frame(scattered));
    return scattered;
  }
};

Material sized(const char* preset, double pixel_mm) {
  return {.profile = dermis::preset(preset).profile, .pixel_mm = pixel_mm, .finest_pixel_mm = pixel_mm / 2};
}

double error_of(const Material& material, TapsDesign design, int rank) {
  design.rank = rank;
  return make_tap_set(material.profile, design, material.pixel_mm).predicted_rel_l2;
}

}  // namespace

TEST_CASE("a quality takes the lowest rank that meets it, and says what its error will be", "[quality]") {
  Random random(901);
  const Device device = Device::open();
  for (const auto& [quality, tolerance] : {std::pair{Quality::draft, 0.05}, std::pair{Quality::final, 0.006}}) {
    CHECK(dermis::tolerance_of(quality) == tolerance);
    const Material material = sized(random.coin() ? "skin" : "marble", random.uniform(0.05, 0.4));
    CAPTURE(tolerance, material.pixel_mm);
    const auto choice = choose_taps({material}, {.quality = quality});
    CHECK(choice.missed.empty());
    CHECK_FALSE(choice.options.quality);
    CHECK(choice.options.sheared == (tolerance < 0.02));
    const Material& chosen = choice.materials.front();
    REQUIRE(chosen.taps);
    CHECK(chosen.pixel_mm == 0);
    CHECK(chosen.taps->tolerance == tolerance);
    const TapsDesign wanted = dermis::design_within(tolerance);
    const int lowest = with_rank(material.profile, wanted, material.pixel_mm).rank;
    CHECK(chosen.taps->rank >= lowest);
    for (int rank = lowest; rank < chosen.taps->rank; ++rank) CHECK(error_of(material, wanted, rank) > tolerance);
    CHECK(error_of(material, *chosen.taps, chosen.taps->rank) <= tolerance);

    const Plan plan(device, {material}, {}, {.quality = quality});
    const dermis::MaterialTaps taps = plan.taps_of(0, material.pixel_mm);
    CHECK(taps.design == *chosen.taps);
    CHECK(taps.count >= 3);
    CHECK(taps.count <= chosen.taps->count);
    // Taps may be off by 5/4 of the error of the model, and errors grow by up to a fifth over the levels that have one
    // count (tap_budget.cpp).
    CHECK(taps.predicted_rel_l2 <= 1.5 * tolerance);
    const Card card(random, 1 / material.pixel_mm);
    CHECK(card.by(plan) == card.by(Plan(device, choice.materials, {}, choice.options)));
  }
}

TEST_CASE("a tolerance that no taps meet takes the exact method, a quality the best taps", "[quality]") {
  const Device device = Device::open();
  Random random(902);
  const Material material = sized("skin", 0.05);
  const auto choice = choose_taps({material}, {.tolerance = 1e-5});
  CHECK(choice.missed == std::vector<std::size_t>{0});
  CHECK(choice.options.method == Method::exact);

  const Card card(random, 4);
  const std::vector<float> exact =
      card.by(Plan(device, {{.profile = material.profile}}, {}, {.method = Method::exact}));
  const Plan fallen_back(device, {material}, {}, {.tolerance = 1e-5});
  CHECK(fallen_back.options().method == Method::exact);
  CHECK(card.by(fallen_back) == exact);
  CHECK(card.by(Plan(device, {material}, {}, {.quality = Quality::reference})) == exact);
  CHECK_THROWS_WITH(fallen_back.taps_of(0), Catch::StartsWith("method: got exact, want separable"));

  // One term is further off than the best quality allows: the material keeps it, and is named.
  Material one_term = material;
  one_term.taps = TapsDesign{.rank = 1, .tolerance = 1e-4};
  const auto best = choose_taps({one_term}, {.quality = Quality::final});
  CHECK(best.missed == std::vector<std::size_t>{0});
  CHECK(best.options.method == Method::separable);
  CHECK(best.materials.front().taps->rank == 1);
}

TEST_CASE("without a quality designs are used as they are", "[quality]") {
  const Material material = sized("wax", 1);
  const Options options{.taps = {.rank = 3, .count = 9}};
  const auto choice = choose_taps({material}, options);
  TapsDesign design = *choice.materials.front().taps;
  CHECK(design.widest_px < TapsDesign{}.widest_px);
  design.widest_px = TapsDesign{}.widest_px;
  CHECK(design == options.taps);
  CHECK(choice.options == options);
}

TEST_CASE("qualities and sizes that cannot be", "[quality]") {
  const auto message = [](const Options& options, double pixel_mm = 0.1) {
    return failure_of([&] { choose_taps({sized("skin", pixel_mm)}, options); }).message;
  };
  CHECK_THAT(message({.tolerance = 1}), Catch::Equals("tolerance: got 1.000000, want at least 0 and below 1"));
  CHECK_THAT(message({.tolerance = -0.5}), Catch::Equals("tolerance: got -0.500000, want at least 0 and below 1"));
  CHECK_THAT(message({.quality = Quality::draft, .tolerance = 0.1}),
             Catch::Equals("tolerance: got it with quality draft, want one of the two"));
  CHECK_THAT(message({.method = Method::disc, .quality = Quality::draft}),
             Catch::Equals("quality: got it with method disc, want method separable"));
  CHECK_THAT(message({.method = Method::exact, .tolerance = 0.1}),
             Catch::Equals("tolerance: got it with method exact, want method separable"));
  CHECK_THAT(message({.quality = Quality::draft}, 1e-13), Catch::Equals("pixel_mm: got 1e-13, want 1e-12..1e12 mm"));
  CHECK_NOTHROW(choose_taps({sized("skin", 0.1)}, {.method = Method::exact, .quality = Quality::reference}));
  CHECK_THROWS_WITH(choose_design(dermis::preset("skin").profile, {}, 0.1), Catch::StartsWith("tolerance: got 0"));
}

TEST_CASE("values of enumerations and their words", "[quality]") {
  for (const auto& [value, name] : dermis::word_table<dermis::Model>) {
    CHECK(name_of(value) == name);
    CHECK(dermis::value_named<dermis::Model>(name) == value);
  }
  CHECK_FALSE(dermis::value_named<Method>("best"));
  CHECK(name_of(Quality::final) == "final");
}
