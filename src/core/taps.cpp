#include "dermis/taps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/radial_table.hpp"
#include "dermis/error.hpp"

namespace dermis {

namespace {

constexpr double share_within_radius = 0.999;

/// The bits of a float32 below those that number rungs.
constexpr int bits_below_rung = 23 - Taps::log2_rungs_per_octave;

/// A run of whole pixels on one side of the centre, in pixel units: from first_px - 1/2 to last_px + 1/2.
struct Run {
  int first_px;
  int last_px;

  double begin_px() const { return first_px - 0.5; }
  double end_px() const { return last_px + 0.5; }
};

/// Splits the pixels beyond the core on one side into at most `count` runs of equal light in the widest channel. A run
/// that would be narrower than a pixel takes one pixel, and the others share what is left.
std::vector<Run> equal_shares(const Profile& profile, int widest, double footprint, int last_px, int core_px,
                              int count) {
  std::vector<Run> runs;
  int next_px = core_px + 1;
  while (next_px <= last_px && static_cast<int>(runs.size()) < count) {
    const int runs_left = count - static_cast<int>(runs.size());
    const double light_left = profile.edge_tail(widest, (next_px - 0.5) / footprint);
    const double light_after = light_left * (1 - 1.0 / runs_left);
    int end_px = last_px;
    if (runs_left > 1) {
      const double end_mm = profile.half_width(widest, 1 - 2 * light_after);
      end_px = std::clamp(static_cast<int>(std::lround(end_mm * footprint - 0.5)), next_px, last_px);
    }
    runs.push_back({next_px, end_px});
    next_px = runs.back().last_px + 1;
  }
  return runs;
}

/// Pixels on each side of the centre that the centre tap stands for. More than 0 only where the taps are so far apart
/// that the centre pixel holds less than half the light of what every other tap stands for.
int core_pixels(const Profile& profile, int widest, double footprint, int count) {
  const double share = 1.0 / (2 * count + 1);
  return std::max(0, static_cast<int>(std::lround(profile.half_width(widest, share) * footprint - 0.5)));
}

/// Where in its run a tap sits: at the pixel that keeps the second moment of the kernel, of the pixels beside the
/// centre of the run's light. The moments that earlier runs owe are carried along.
class Placement {
 public:
  Placement(const Profile& profile, int widest, double footprint)
      : profile_(profile), widest_(widest), footprint_(footprint) {}

  int offset_px(const Run& run) {
    double light = 0;
    double first_moment = 0;
    double second_moment = 0;
    const int parts = std::min(run.last_px - run.first_px + 1, max_parts);
    const double part_px = (run.end_px() - run.begin_px()) / parts;
    double light_beyond = profile_.edge_tail(widest_, run.begin_px() / footprint_);
    for (int i = 0; i < parts; ++i) {
      const double end_px = run.begin_px() + (i + 1) * part_px;
      const double middle_px = end_px - part_px / 2;
      const double light_before = light_beyond;
      light_beyond = profile_.edge_tail(widest_, end_px / footprint_);
      const double share = light_before - light_beyond;
      light += share;
      first_moment += share * middle_px;
      second_moment += share * middle_px * middle_px;
    }
    if (light <= 0) return run.first_px;
    const int low = std::clamp(static_cast<int>(first_moment / light), run.first_px, run.last_px);
    const int high = std::min(low + 1, run.last_px);
    const double owed_low = owed_ + second_moment - light * low * low;
    const double owed_high = owed_ + second_moment - light * high * high;
    const bool take_low = std::abs(owed_low) <= std::abs(owed_high);
    owed_ = take_low ? owed_low : owed_high;
    return take_low ? low : high;
  }

 private:
  static constexpr int max_parts = 16;  ///< of a run, for its moments

  const Profile& profile_;
  int widest_;
  double footprint_;
  double owed_ = 0;
};

Rung make_rung(const Profile& profile, const RadialTable& falloff, int widest, double radius_mm, double footprint,
               int count) {
  const int last_px = std::max(1, static_cast<int>(std::ceil(radius_mm * footprint - 0.5)));
  const bool dense = last_px <= count;
  const int core_px = dense ? 0 : core_pixels(profile, widest, footprint, count);
  Rung rung{static_cast<float>(footprint), static_cast<float>(core_px + 0.5), {}};
  Placement placement(profile, widest, footprint);
  for (const Run& run : equal_shares(profile, widest, footprint, last_px, core_px, dense ? last_px : count)) {
    TapPair pair{placement.offset_px(run), {}};
    const double distance_mm = pair.offset_px / footprint;
    for (int c = 0; c < 3; ++c) {
      // The last run also takes the light beyond the radius.
      const double beyond = run.last_px == last_px ? 0 : profile.edge_tail(c, run.end_px() / footprint);
      const double light = profile.edge_tail(c, run.begin_px() / footprint) - beyond;
      const double density = value_at(falloff, c, distance_mm * distance_mm);
      pair.length_mm[c] = density > 0 ? static_cast<float>(light / density) : 0.0F;
    }
    rung.pairs.push_back(pair);
  }
  return rung;
}

}  // namespace

int Taps::rung_index(float radius_px) {
  if (!(radius_px >= min_radius_px)) return -1;
  const auto steps =
      (std::bit_cast<std::uint32_t>(radius_px) - std::bit_cast<std::uint32_t>(min_radius_px)) >> bits_below_rung;
  return std::min(static_cast<int>(steps), (octaves << log2_rungs_per_octave) - 1);
}

Taps Taps::importance_sampled(const Profile& profile, int count) {
  if (count < 3 || count > 127 || count % 2 == 0) {
    throw Error(ErrorCode::usage, "taps", std::to_string(count), "an odd number, 3..127");
  }
  const int widest = profile.widest_channel();
  Taps taps;
  taps.radius_mm = profile.half_width(widest, share_within_radius);
  for (int c = 0; c < 3; ++c) {
    const double radius_mm = profile.half_width(c, share_within_radius);
    taps.radius_mm = std::max(taps.radius_mm, radius_mm);
    taps.relative_width[c] = static_cast<float>(radius_mm);
  }
  for (float& width : taps.relative_width) width = static_cast<float>(width / taps.radius_mm);

  // 32 nodes per octave of r^2: linear interpolation is off by less than 1e-4 where the profile still holds light. The
  // finest distance is that between pixels of the last rung; tilt stretches distances beyond the radius.
  const double finest_mm = taps.radius_mm * std::ldexp(1.0, -octaves);
  constexpr int log2_nodes_per_octave = 5;
  taps.falloff = tabulate([&](int c, double r) { return profile.marginal(c, r); }, finest_mm, 2 * taps.radius_mm,
                          log2_nodes_per_octave);
  taps.core = tabulate([&](int c, double r) { return 1 - 2 * profile.edge_tail(c, r); }, finest_mm, 4 * taps.radius_mm,
                       log2_nodes_per_octave);

  constexpr int per_octave = 1 << log2_rungs_per_octave;
  for (int i = 0; i < octaves * per_octave; ++i) {
    const double middle = 1 + (i % per_octave + 0.5) / per_octave;
    const double radius_px = std::ldexp(min_radius_px * middle, i / per_octave);
    taps.rungs.push_back(
        make_rung(profile, taps.falloff, widest, taps.radius_mm, radius_px / taps.radius_mm, count / 2));
  }
  return taps;
}

}  // namespace dermis
