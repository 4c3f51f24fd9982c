#include "commands/chosen_designs.hpp"

#include <algorithm>
#include <cstddef>
#include <future>
#include <optional>
#include <string>

#include "dermis/tap_tables.hpp"

namespace dermis::program {
namespace {

struct Choice {
  TapsDesign design;
  double predicted_rel_l2 = 0;
};

double predicted_rel_l2(const Profile& profile, TapsDesign design, double pixel_mm) {
  design.tolerance = 0;
  return make_tap_set(profile, design, pixel_mm).predicted_rel_l2;
}

/// The first that is good enough, else the best: the wanted number of taps with one rank after the other, then more of
/// the highest.
Choice choose(const Profile& profile, const TapsDesign& wanted, double pixel_mm) {
  constexpr int most_fitted_taps = 65;
  const int lowest = with_rank(profile, wanted, pixel_mm).rank;
  const int highest = wanted.rank > 0 ? lowest : highest_rank(wanted.model);
  std::optional<Choice> best;
  for (const int count : {wanted.count, std::max(wanted.count, most_fitted_taps)}) {
    for (int rank = count == wanted.count ? lowest : highest; rank <= highest; ++rank) {
      TapsDesign design = wanted;
      design.rank = rank;
      design.count = count;
      // Of the fewest taps that will do: all of them take several times as long to place.
      const double error = make_tap_set(profile, design, pixel_mm).predicted_rel_l2;
      if (!best || error < best->predicted_rel_l2) best = {design, error};
      if (error <= wanted.tolerance) return *best;
    }
  }
  return *best;
}

/// What a tolerance makes of the design for pixels of one size.
int taps_at(const Profile& profile, const TapsDesign& design, double pixel_mm) {
  const Taps taps = make_taps(profile, design);
  const int level = Taps::level_index(static_cast<float>(taps.radius_mm / pixel_mm));
  return level < 0 ? 1 : 2 * static_cast<int>(taps.levels[static_cast<std::size_t>(level)].offsets_px.size()) + 1;
}

void report_design(const Profile& profile, const TapsDesign& design, MaterialReport& material) {
  material.design = design;
  material.design->rank = with_rank(profile, design).rank;
  if (!material.pixel_mm) return;
  TapsDesign there = *material.design;
  material.taps = design.count;
  if (design.tolerance > 0) material.taps = taps_at(profile, *material.design, *material.pixel_mm);
  // Narrow kernels have fewer taps than any design.
  there.count = std::max(*material.taps, 3);
  material.predicted_rel_l2 = predicted_rel_l2(profile, there, *material.pixel_mm);
}

}  // namespace

std::vector<std::string> choose_designs(std::vector<NamedProfile>& profiles,
                                        const std::vector<MaterialReport>& materials, const TapsDesign& wanted) {
  std::vector<std::future<Choice>> searches;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    searches.push_back(std::async([&wanted, &profile = profiles[i].profile, pixel_mm = materials[i].pixel_mm] {
      return pixel_mm ? choose(profile, wanted, *pixel_mm) : Choice{with_rank(profile, wanted), 0};
    }));
  }
  std::vector<std::string> without;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const Choice choice = searches[i].get();
    profiles[i].taps = choice.design;
    if (choice.predicted_rel_l2 > wanted.tolerance)
      without.push_back(profiles[i].id ? "--material " + std::to_string(*profiles[i].id) : "--profile");
  }
  return without;
}

void report_designs(const std::vector<NamedProfile>& profiles, const TapsDesign& for_all,
                    std::vector<MaterialReport>& materials) {
  std::vector<std::future<void>> reports;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    reports.push_back(
        std::async([&, i] { report_design(profiles[i].profile, profiles[i].taps.value_or(for_all), materials[i]); }));
  }
  for (auto& report : reports) report.get();
}

}  // namespace dermis::program
