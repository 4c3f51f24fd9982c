// What the separable method promises under numerical stress: the table in bench/stress/rows.hpp.
#include <cmath>
#include <limits>
#include <set>

#include "stress/errors.hpp"
#include "stress/filter.hpp"
#include "stress/sums.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace oracle = dermis::oracle;
using dermis::Device;
using dermis::Format;
using dermis::bench::StressErrors;
using dermis::bench::StressRow;
using dermis::bench::SumRow;

TEST_CASE("the filter keeps its promises under numerical stress", "[stress]") {
  const std::vector<StressRow> rows = dermis::bench::stress_rows(Device::open(), test_seed());
  std::set<std::string> groups;
  for (const StressRow& row : rows) {
    CAPTURE(test_seed(), row.group, row.name, row.promised, row.rel_l2, row.of_bound, row.energy, row.overshoot);
    INFO(row.failure);
    CHECK(row.holds());
    CHECK(row.non_finite == 0);
    groups.insert(row.group);
  }
  CHECK(groups == std::set<std::string>{"bad light", "camera", "depth", "frame", "light", "profile"});
  CHECK(rows.size() >= 40);
}

TEST_CASE("stress finds what is wrong", "[stress]") {
  // A picture that is the oracle's but for one thing.
  Random random(900);
  oracle::Reference expected;
  expected.scattered = oracle::Picture(9, 5, 3);
  expected.scattered_bound = oracle::Picture(9, 5, 3, 1e-6);
  for (double& value : expected.scattered.values) value = random.uniform(0.5, 2);
  const auto errors = [&](const oracle::Picture& seen) {
    StressErrors collected(Format::f32);
    collected.add(seen, 0, expected, 0, seen.width);
    StressRow row;
    collected.write_to(row, true);
    return row;
  };
  CHECK(errors(expected.scattered).rel_l2 == 0);
  CHECK(errors(expected.scattered).of_bound == 0);
  oracle::Picture seen = expected.scattered;
  seen(random.integer(0, 8), random.integer(0, 4), random.integer(0, 2)) += 2e-6;
  CHECK(errors(seen).of_bound == Approx(2));
  // One of 135 values between 0.5 and 2.
  CHECK(errors(seen).rel_l2 > 2e-6 / (2 * std::sqrt(135.0)));
  CHECK(errors(seen).rel_l2 < 2e-6 / (0.5 * std::sqrt(135.0)));
  seen(random.integer(0, 8), random.integer(0, 4), random.integer(0, 2)) = std::numeric_limits<double>::quiet_NaN();
  CHECK(errors(seen).non_finite == 1);

  // A filter of other taps is not within the bounds of these.
  const Device device = Device::open();
  const std::vector<dermis::Material> materials = {{0, dermis::preset("skin").profile}};
  const auto filter = [&](int count) {
    return dermis::bench::StressFilter(
        device, materials, {},
        {.taps = {.model = dermis::Model::pre_integrated, .count = count, .placement = dermis::Placement::importance}});
  };
  std::mt19937 engine(test_seed());
  const dermis::bench::StressField field = dermis::bench::stress_plane(engine, 40, 24, 4);
  StressErrors collected(Format::f32);
  collected.add(filter(11).run(field).values, 0, filter(13).reference(field), 0, field.width_px);
  StressRow row;
  collected.write_to(row, true);
  CHECK(row.rel_l2 > 4e-5);
  CHECK(row.of_bound > 10);
}

TEST_CASE("sums in float are off by what their order allows", "[stress]") {
  constexpr double u = 0x1p-24;
  const std::vector<SumRow> rows = dermis::bench::study_sums(test_seed(), 50);
  const auto of = [&](const std::string& how) {
    for (const SumRow& row : rows) {
      if (row.how == how) return row;
    }
    FAIL("no row " << how);
    return SumRow{};
  };
  for (std::size_t s = 0; s < dermis::bench::sum_sizes.size(); ++s) {
    const int n = dermis::bench::sum_sizes[s];
    CAPTURE(test_seed(), n);
    CHECK(of("rounded once, from double").max[s] <= 1.01 * u);
    // All terms are above 0: n roundings above the line (products and sums), n below, a division.
    for (const char* how : {"in order", "in order, fused", "backwards", "4 lanes", "16 lanes", "pairwise"}) {
      CAPTURE(how);
      CHECK(of(how).max[s] <= (2 * n + 2) * u);
      CHECK(of(how).max[s] > 0.1 * u);
    }
    // A product, 2 u for each of both sums, a division.
    CHECK(of("Kahan").max[s] <= 7 * u);
    // Every value to 11 bits.
    CHECK(of("half values, float sums").max[s] <= 0x1p-11 + (2 * n + 2) * u);
    CHECK(of("half values, float sums").rms[s] > 2 * of("in order").rms[s]);
  }
  CHECK(of("in order").rms.back() > of("Kahan").rms.back());
  CHECK(of("in order").rms.back() > of("pairwise").rms.back());
}
