#include "taps/tap_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dermis/tap_tables.hpp"

namespace dermis {

namespace {

/// So many levels in a row have one count, which is the one that the widest of them needs. Errors grow by a tenth or
/// two from the first to the last, and to predict the error of every level would take as long as all fits.
constexpr int group = 4;

/// Offsets for one radius, as a start for a radius that is `ratio` times as large.
std::vector<double> scaled(std::vector<double> offsets_px, double ratio) {
  for (double& offset_px : offsets_px) offset_px *= ratio;
  return offsets_px;
}

/// Where there are many taps, those of a level are those of the level before, scaled: a search for each would take a
/// second.
bool is_searched_at_every_level(int rank, std::size_t pairs) {
  constexpr std::size_t most_unknowns = 24;
  return static_cast<std::size_t>(rank) * pairs <= most_unknowns;
}

}  // namespace

std::vector<int> tap_counts(const TapsDesign& design) {
  if (design.tolerance == 0) return {design.count};
  constexpr std::array counts = {5, 7, 11, 17, 25, 33, 49, 65};
  std::vector<int> result;
  std::copy_if(counts.begin(), counts.end(), std::back_inserter(result),
               [&](int count) { return count < design.count; });
  result.push_back(design.count);
  return result;
}

double worthwhile_rel_l2(const DesignedTaps& designed, double tolerance, double pixel_mm) {
  constexpr double of_model = 1.25;
  return std::max(tolerance, of_model * designed.model_rel_l2(pixel_mm));
}

double middle_radius_px(int level) {
  constexpr int levels_per_octave = 1 << Taps::log2_levels_per_octave;
  const double middle = 1 + (level % levels_per_octave + 0.5) / levels_per_octave;
  return std::ldexp(Taps::min_radius_px * middle, level / levels_per_octave);
}

TapBudget::TapBudget(const Profile& profile, const TapsDesign& design) : design_(design) {
  const DesignedTaps designed(profile, design);
  for (const int count : tap_counts(design)) by_count_.push_back(designed.with_count(count));
}

SizedTaps TapBudget::at(int level) {
  const int place = level % group;
  if (place == 0) {
    ahead_.reset();
    if (!has_highest_count()) ahead_ = good_enough(level + group - 1);
  }
  if (place == group - 1 && ahead_) return *std::exchange(ahead_, std::nullopt);
  return fitted(level, place == 0);
}

SizedTaps TapBudget::good_enough(int level) {
  const double pixel_mm = designed().radius_mm() / middle_radius_px(level);
  std::optional<double> worthwhile;
  const auto is_enough = [&](const SizedTaps& taps) {
    const double error = designed().predicted_rel_l2(taps.placed, pixel_mm);
    if (error <= design_.tolerance) return true;
    if (!worthwhile) worthwhile = worthwhile_rel_l2(designed(), design_.tolerance, pixel_mm);
    return error <= *worthwhile;
  };
  SizedTaps taps = fitted(level, true);
  if (is_enough(taps)) return taps;
  // A search near the taps of the level before may end at twice the least error where kernels are some pixels wide. So
  // one everywhere has to fail too before the count is raised.
  for (near_px_.clear();; ++present_) {
    taps = fitted(level, true);
    if (has_highest_count() || is_enough(taps)) return taps;
  }
}

SizedTaps TapBudget::fitted(int level, bool searches) {
  const DesignedTaps& designed = by_count_[present_];
  const auto pairs = static_cast<std::size_t>(designed.count() / 2);
  const double radius_px = middle_radius_px(level);
  searches = searches || is_searched_at_every_level(design_.rank, pairs);
  const Search search = near_px_.size() != pairs ? Search::everywhere : searches ? Search::nearby : Search::nowhere;
  SizedTaps taps = designed.at(designed.radius_mm() / radius_px, Fetch::integer, search,
                               scaled(near_px_, radius_px / near_radius_px_));
  near_px_ = taps.placed.offsets_px;
  near_radius_px_ = radius_px;
  return taps;
}

}  // namespace dermis
