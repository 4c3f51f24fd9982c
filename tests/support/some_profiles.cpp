#include "support/some_profiles.hpp"

#include <cmath>

#include "support/random.hpp"

using dermis::Profile;
using dermis::Rgb;
using dermis::TableRow;

namespace {

/// Returns rows of a curve that rises and falls, or only falls. A curve that is `cut` ends above 0.
std::vector<TableRow> random_rows(Random& random, double mm, bool from_zero, bool cut) {
  std::vector<TableRow> rows;
  double r = from_zero ? 0 : random.uniform(0.02, 0.1);
  for (int i = 0; i < 12; ++i) {
    TableRow row{r * mm, {}};
    for (int c = 0; c < 3; ++c) row.value[c] = std::exp(-r * (1 + 0.5 * c)) * random.uniform(0.3, 1);
    rows.push_back(row);
    r += random.uniform(0.05, 0.6);
  }
  if (!cut) rows.push_back({r * mm, {}});
  return rows;
}

SomeProfile tabulated(const char* name, const std::vector<TableRow>& rows) {
  SomeProfile result{name, Profile::tabulated(rows)};
  for (const TableRow& row : rows) result.breaks.push_back(row.r_mm);
  return result;
}

}  // namespace

std::vector<double> SomeProfile::breaks_along(double x_mm) const {
  std::vector<double> along;
  for (const double r : breaks) {
    if (r > x_mm) along.push_back(std::sqrt((r - x_mm) * (r + x_mm)));
  }
  return along;
}

std::vector<SomeProfile> profiles_of_every_kind(unsigned salt, double mm) {
  Random random(salt);
  const auto number = [&](double low, double high) { return std::exp(random.uniform(std::log(low), std::log(high))); };
  const auto lengths = [&] { return Rgb{number(.05, 20) * mm, number(.05, 20) * mm, number(.05, 20) * mm}; };
  const auto shares = [&] { return Rgb{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)}; };
  const auto coefficients = [&](double low, double high) {
    return Rgb{number(low, high) / mm, number(low, high) / mm, number(low, high) / mm};
  };
  const auto variance = [&] { return number(.01, 100) * mm * mm; };
  std::vector<SomeProfile> profiles;
  profiles.push_back({"burley", Profile::burley(lengths())});
  profiles.push_back({"burley_mfp", Profile::burley_mfp(lengths(), shares())});
  profiles.push_back({"burley_cycles", Profile::burley_cycles(lengths())});
  profiles.push_back({"random_walk_cycles", Profile::random_walk_cycles(lengths(), shares())});
  profiles.push_back({"random_walk_cycles, the albedo of each pixel", Profile::random_walk_cycles(lengths())});
  profiles.push_back({"random_walk_mfp", Profile::random_walk_mfp(lengths(), shares())});
  profiles.push_back({"gaussians", Profile::gaussians({{variance(), {1, 2, 3}}, {variance(), {4, 0, 1}}})});
  profiles.push_back({"artist", Profile::artist(lengths(), lengths(), random.uniform(0.01, 0.99))});
  const double eta = random.uniform(1, 2.5);
  profiles.push_back({"dipole, little absorbed", Profile::dipole(coefficients(.3, 20), coefficients(.0012, .01), eta)});
  profiles.push_back({"dipole, much absorbed", Profile::dipole(coefficients(.03, 1), coefficients(.1, 10), eta)});
  profiles.push_back(
      {"better dipole, little absorbed", Profile::better_dipole(coefficients(.3, 20), coefficients(.0012, .01), eta)});
  profiles.push_back(
      {"better dipole, much absorbed", Profile::better_dipole(coefficients(.03, 1), coefficients(.1, 10), eta)});
  profiles.push_back(tabulated("table", random_rows(random, mm, true, false)));
  profiles.push_back(tabulated("table from further out", random_rows(random, mm, false, false)));
  profiles.push_back(tabulated("table that is cut", random_rows(random, mm, true, true)));
  return profiles;
}

std::vector<SomeProfile> some_profiles(unsigned salt) {
  std::vector<SomeProfile> profiles = profiles_of_every_kind(salt);
  for (const dermis::Preset& preset : dermis::presets()) profiles.push_back({preset.name, preset.profile});
  return profiles;
}

double negligible_from(const Profile& profile, int channel, double r_mm) {
  const double there = profile.radial(channel, r_mm);
  const double step = profile.radius(channel, 0.5);
  double far = r_mm + step;
  while (profile.radial(channel, far) > 1e-22 * there) far += step + 0.1 * (far - r_mm);
  return far;
}
