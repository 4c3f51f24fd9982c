#include "taps/placement/tap_runs.hpp"

#include <algorithm>
#include <cmath>

namespace dermis {

namespace {

/// Splits the pixels beyond the centre into at most `pairs` runs of equal light in the widest channel. A run that would
/// be narrower than a pixel takes one pixel, and the others share what is left.
TapRuns equal_shares(const Profile& profile, int widest, double px_per_mm, int last_px, int pairs) {
  // The centre is more than a pixel only where the taps are so far apart that the centre pixel holds less than half the
  // light of what every other tap stands for.
  const double centre_share = 1.0 / (2 * pairs + 1);
  TapRuns result;
  result.centre_px =
      std::max(0, static_cast<int>(std::lround(profile.half_width(widest, centre_share) * px_per_mm - 0.5)));
  int next_px = result.centre_px + 1;
  while (next_px <= last_px && static_cast<int>(result.runs.size()) < pairs) {
    const int runs_left = pairs - static_cast<int>(result.runs.size());
    const double light_left = profile.edge_tail(widest, (next_px - 0.5) / px_per_mm);
    const double light_after = light_left * (1 - 1.0 / runs_left);
    int end_px = last_px;
    if (runs_left > 1) {
      const double end_mm = profile.half_width(widest, 1 - 2 * light_after);
      end_px = std::clamp(static_cast<int>(std::lround(end_mm * px_per_mm - 0.5)), next_px, last_px);
    }
    result.runs.push_back({next_px, end_px});
    next_px = result.runs.back().last_px + 1;
  }
  return result;
}

/// Runs between boundaries, the first of which ends the centre; each boundary moves to the nearest edge of a pixel that
/// leaves a pixel for every run.
TapRuns between(const std::vector<double>& boundaries_px, int last_px) {
  const auto runs = static_cast<int>(boundaries_px.size()) - 1;
  TapRuns result;
  result.centre_px = std::clamp(static_cast<int>(std::lround(boundaries_px[0] - 0.5)), 0, last_px - runs);
  int before_px = result.centre_px;
  for (int i = 1; i <= runs; ++i) {
    const int end_px =
        std::clamp(static_cast<int>(std::lround(boundaries_px[i] - 0.5)), before_px + 1, last_px - (runs - i));
    result.runs.push_back({before_px + 1, end_px});
    before_px = end_px;
  }
  return result;
}

/// Offsets of which the n-th is last (n / pairs)^power, each with the pixels that are nearest to it.
TapRuns nearest_to_powers(int last_px, int pairs, double power) {
  const int runs = std::min(pairs, last_px);
  const auto offset_px = [&](int n) { return last_px * std::pow(static_cast<double>(n) / runs, power); };
  std::vector<double> boundaries_px;
  boundaries_px.reserve(static_cast<std::size_t>(runs) + 1);
  for (int n = 0; n < runs; ++n) boundaries_px.push_back((offset_px(n) + offset_px(n + 1)) / 2);
  boundaries_px.push_back(last_px + 0.5);
  return between(boundaries_px, last_px);
}

/// The light of a run, and its first and second moment about the centre.
struct Moments {
  double light = 0;
  double first = 0;
  double second = 0;

  Moments(const Profile& profile, int channel, const TapRun& run, double px_per_mm) {
    constexpr int most_parts = 16;
    const int parts = std::min(run.last_px - run.first_px + 1, most_parts);
    const double part_px = (run.end_px() - run.begin_px()) / parts;
    double light_beyond = profile.edge_tail(channel, run.begin_px() / px_per_mm);
    for (int i = 0; i < parts; ++i) {
      const double end_px = run.begin_px() + (i + 1) * part_px;
      const double middle_px = end_px - part_px / 2;
      const double light_before = light_beyond;
      light_beyond = profile.edge_tail(channel, end_px / px_per_mm);
      const double share = light_before - light_beyond;
      light += share;
      first += share * middle_px;
      second += share * middle_px * middle_px;
    }
  }
};

}  // namespace

TapRuns every_pixel(int last_px) {
  TapRuns result;
  for (int i = 1; i <= last_px; ++i) result.runs.push_back({i, i});
  return result;
}

TapRuns make_runs(const Profile& profile, int widest, Placement placement, double px_per_mm, int last_px, int pairs) {
  switch (placement) {
    case Placement::uniform:
      return nearest_to_powers(last_px, pairs, 1);
    case Placement::quadratic:
      return nearest_to_powers(last_px, pairs, 2);
    case Placement::importance:
    case Placement::optimised:
      break;
  }
  return equal_shares(profile, widest, px_per_mm, last_px, pairs);
}

std::vector<double> offsets_in(const Profile& profile, int widest, const TapRuns& runs, double px_per_mm, Fetch fetch) {
  std::vector<double> offsets_px;
  double owed = 0;
  for (const TapRun& run : runs.runs) {
    const Moments moments(profile, widest, run, px_per_mm);
    if (!(moments.light > 0)) {
      offsets_px.push_back(run.first_px);
      continue;
    }
    const double centre_px = moments.first / moments.light;
    if (fetch == Fetch::linear) {
      offsets_px.push_back(std::clamp<double>(centre_px, run.first_px, run.last_px));
      continue;
    }
    const int low = std::clamp(static_cast<int>(centre_px), run.first_px, run.last_px);
    const int high = std::min(low + 1, run.last_px);
    const double owed_low = owed + moments.second - moments.light * low * low;
    const double owed_high = owed + moments.second - moments.light * high * high;
    const bool take_low = std::abs(owed_low) <= std::abs(owed_high);
    owed = take_low ? owed_low : owed_high;
    offsets_px.push_back(take_low ? low : high);
  }
  return offsets_px;
}

}  // namespace dermis
