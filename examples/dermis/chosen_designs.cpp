#include "chosen_designs.hpp"

#include <cstddef>
#include <future>
#include <optional>
#include <string>

#include "dermis/taps.hpp"

namespace dermis::program {

std::vector<std::string> choose_designs(std::vector<NamedProfile>& profiles,
                                        const std::vector<MaterialReport>& materials, double tolerance) {
  std::vector<std::future<std::optional<TapsDesign>>> searches;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const auto pixel_mm = materials[i].pixel_mm;
    if (!pixel_mm) {
      searches.emplace_back();
      continue;
    }
    searches.push_back(std::async([&profile = profiles[i].profile, tolerance, mm = *pixel_mm] {
      return cheapest_design(profile, tolerance, mm);
    }));
  }
  std::vector<std::string> without;
  std::vector<std::optional<TapsDesign>> found;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    found.push_back(searches[i].valid() ? searches[i].get() : profiles[i].taps);
    if (materials[i].pixel_mm && !found[i])
      without.push_back(profiles[i].id ? "--material " + std::to_string(*profiles[i].id) : "--profile");
  }
  for (std::size_t i = 0; i < profiles.size() && without.empty(); ++i) profiles[i].taps = found[i];
  return without;
}

void report_designs(const std::vector<NamedProfile>& profiles, const TapsDesign& for_all,
                    std::vector<MaterialReport>& materials) {
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const TapsDesign design = profiles[i].taps.value_or(for_all);
    materials[i].design = design;
    if (materials[i].pixel_mm)
      materials[i].predicted_rel_l2 =
          make_tap_set(profiles[i].profile, design, *materials[i].pixel_mm).predicted_rel_l2;
  }
}

}  // namespace dermis::program
