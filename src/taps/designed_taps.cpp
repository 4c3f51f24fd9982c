#include "taps/designed_taps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "taps/model/gaussian_mixture.hpp"

namespace dermis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The share of the widest channel's light that lies within the radius. More terms are worth more of it.
double share_within_radius(const TapsDesign& design) {
  return design.rank == 1 ? 0.999 : design.rank == 2 ? 0.9999 : 0.99999;
}

std::shared_ptr<const PowerGrid> grid_of(int period_px) {
  static std::map<int, std::shared_ptr<const PowerGrid>> grids;
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);  // another thread that wants this one waits for it
  auto& grid = grids[period_px];
  if (!grid) grid = std::make_shared<PowerGrid>(period_px);
  return grid;
}

/// Kernels that reach farther are compared on larger pixels, as the period would be too long.
constexpr int farthest_px = 4000;
constexpr int least_reach_px = 127;  // the period is then at least that of the images

/// A period that keeps products of two rows of taps apart.
int period_for(int last_px) {
  int period = 256;
  while (period < 4 * last_px + 4) period *= 2;
  return period;
}

/// Offsets near the given ones that are whole if they have to be, at least a pixel apart and not beyond last_px.
std::vector<double> valid_offsets(std::vector<double> offsets_px, int last_px, Fetch fetch) {
  const auto count = static_cast<int>(offsets_px.size());
  for (int i = 0; i < count; ++i) {
    double& offset_px = offsets_px[i];
    if (fetch == Fetch::integer) offset_px = std::round(offset_px);
    offset_px = std::max(offset_px, i == 0 ? 1 : offsets_px[i - 1] + 1);
  }
  for (int i = count - 1; i >= 0; --i) {
    offsets_px[i] = std::min(offsets_px[i], static_cast<double>(last_px - (count - 1 - i)));
  }
  return offsets_px;
}

}  // namespace

DesignedTaps::DesignedTaps(const Profile& profile, const TapsDesign& design)
    : profile_(profile), design_(design), widest_(profile.widest_channel()), model_(make_model(profile, design)) {
  for (int c = 0; c < 3; ++c) {
    mixtures_[c] = mixture_of(profile, c);
    radius_mm_ = std::max(radius_mm_, radius_mm(c));
  }
  // Few taps are better spent nearer than where the last thousandths of the light are.
  constexpr double share_worth_a_tap = 0.998;
  worth_mm_ = profile.half_width(widest_, share_worth_a_tap);
}

double DesignedTaps::radius_mm(int channel) const { return profile_.half_width(channel, share_within_radius(design_)); }

std::array<MatrixXd, 3> DesignedTaps::run_weights(const TapRuns& runs, double pixel_mm) const {
  std::array<MatrixXd, 3> weights;
  for (int c = 0; c < 3; ++c) {
    weights[c].resize(static_cast<Index>(runs.runs.size()) + 1, static_cast<Index>(model_.size()));
    for (std::size_t t = 0; t < model_.size(); ++t) {
      const TermFunction& f = model_[t].functions[c];
      double outside = 0;
      double beyond = tail_of(profile_, c, f, runs.runs.front().begin_px() * pixel_mm);
      for (std::size_t i = 0; i < runs.runs.size(); ++i) {
        const TapRun& run = runs.runs[i];
        // The last run also takes what lies beyond the radius.
        const double from_here = beyond;
        beyond = i + 1 == runs.runs.size() ? 0 : tail_of(profile_, c, f, run.end_px() * pixel_mm);
        double light = from_here - beyond;
        if (model_[t].normalised) light = std::max(light, 0.0);
        weights[c](static_cast<Index>(i) + 1, static_cast<Index>(t)) = light;
        outside += 2 * light;
      }
      weights[c](0, static_cast<Index>(t)) = f.sum() - outside;
    }
  }
  return weights;
}

const std::array<ChannelOnPixels, 3>& DesignedTaps::on_pixels(double pixel_mm, int last_px) const {
  const int period_px = period_for(last_px);
  if (!latest_->channels || latest_->pixel_mm != pixel_mm || latest_->period_px != period_px) {
    const auto grid = grid_of(period_px);
    const auto channel = [&](int c) { return ChannelOnPixels(grid, mixtures_[c], model_, c, pixel_mm); };
    latest_->channels =
        std::make_unique<const std::array<ChannelOnPixels, 3>>(std::array{channel(0), channel(1), channel(2)});
    latest_->pixel_mm = pixel_mm;
    latest_->period_px = period_px;
  }
  return *latest_->channels;
}

double DesignedTaps::predicted_rel_l2(const PlacedTaps& placed, double pixel_mm) const {
  PlacedTaps taps = placed;
  while (!taps.offsets_px.empty() && taps.offsets_px.back() > farthest_px) {
    for (double& offset_px : taps.offsets_px) offset_px /= 2;
    pixel_mm *= 2;
  }
  const int last_px = taps.offsets_px.empty() ? 1 : static_cast<int>(std::ceil(taps.offsets_px.back()));
  const auto& channels = on_pixels(pixel_mm, std::max(last_px, least_reach_px));
  std::array<double, 3> errors{};
  std::array<double, 3> truths{};
  for (int c = 0; c < 3; ++c) {
    errors[c] = channels[c].squared_error(responses_of(taps, c, channels[c].grid()));
    truths[c] = channels[c].truth_power();
  }
  return relative_l2(errors, truths);
}

double DesignedTaps::model_rel_l2(double pixel_mm) const {
  pixel_mm = std::max(pixel_mm, radius_mm_ / farthest_px);
  const auto& channels = on_pixels(pixel_mm, std::max(static_cast<int>(radius_mm_ / pixel_mm), least_reach_px));
  std::array<double, 3> errors{};
  std::array<double, 3> truths{};
  for (int c = 0; c < 3; ++c) {
    errors[c] = channels[c].squared_error(channels[c].model());
    truths[c] = channels[c].truth_power();
  }
  return relative_l2(errors, truths);
}

DesignedTaps DesignedTaps::with_count(int count) const {
  DesignedTaps result = *this;
  result.design_.count = count;
  return result;
}

SizedTaps DesignedTaps::at(double pixel_mm, Fetch fetch, Search search, const std::vector<double>& near_px) const {
  const double px_per_mm = 1 / pixel_mm;
  const double exact_last_px = std::ceil(radius_mm_ * px_per_mm - 0.5);
  const int pairs = design_.count / 2;
  // Pixels of the widest kernels are small against everything: they have the taps of kernels half as wide, spread out.
  const int widest_px = pairs <= most_fitted_pairs ? 1024 : 32768;
  if (exact_last_px > widest_px) {
    const int doublings = static_cast<int>(std::ceil(std::log2(exact_last_px / widest_px)));
    std::vector<double> near = near_px;
    for (double& offset_px : near) offset_px = std::ldexp(offset_px, -doublings);
    SizedTaps taps = at(std::ldexp(pixel_mm, doublings), fetch, search, near);
    for (double& offset_px : taps.placed.offsets_px) offset_px = std::ldexp(offset_px, doublings);
    taps.centre_half_width_px = std::ldexp(taps.centre_half_width_px, doublings);
    return taps;
  }
  const int last_px = std::max(1, static_cast<int>(exact_last_px));
  const bool dense = last_px <= pairs;
  if (!dense && design_.placement == Placement::optimised && pairs <= most_fitted_pairs) {
    return fitted(pixel_mm, last_px, fetch, search, near_px);
  }
  const TapRuns runs =
      dense ? every_pixel(last_px) : make_runs(profile_, widest_, design_.placement, px_per_mm, last_px, pairs);
  SizedTaps taps;
  taps.placed.offsets_px = offsets_in(profile_, widest_, runs, px_per_mm, dense ? Fetch::integer : fetch);
  taps.placed.weights = run_weights(runs, pixel_mm);
  taps.centre_half_width_px = runs.centre_px + 0.5;
  return taps;
}

SizedTaps DesignedTaps::fitted(double pixel_mm, int last_px, Fetch fetch, Search search,
                               const std::vector<double>& near_px) const {
  const int worth_px = static_cast<int>(std::ceil(worth_mm_ / pixel_mm - 0.5));
  last_px = std::max({1, design_.count / 2, std::min(last_px, worth_px)});
  if (search != Search::everywhere) {
    // The farthest tap is not far from where it was.
    const int near_last_px = static_cast<int>(near_px.back() * 1.25) + 2;
    last_px = std::clamp(near_last_px, design_.count / 2, last_px);
  }
  const auto& channels = on_pixels(pixel_mm, last_px);
  std::vector<double> start_px = near_px;
  if (search == Search::everywhere) {
    const TapRuns runs = make_runs(profile_, widest_, Placement::importance, 1 / pixel_mm, last_px, design_.count / 2);
    start_px = offsets_in(profile_, widest_, runs, 1 / pixel_mm, fetch);
  }
  start_px = valid_offsets(std::move(start_px), last_px, fetch);
  std::vector<bool> non_negative;
  for (const ModelTerm& term : model_) non_negative.push_back(term.normalised);
  std::array<VectorXd, 3> sums;
  for (int c = 0; c < 3; ++c) {
    sums[c].resize(static_cast<Index>(model_.size()));
    for (std::size_t t = 0; t < model_.size(); ++t) sums[c][static_cast<Index>(t)] = model_[t].functions[c].sum();
  }
  SizedTaps taps;
  taps.placed =
      fit_taps(channels, start_px, search, last_px, fetch, design_.model == Model::optimised, non_negative, sums);
  taps.centre_half_width_px = centre_half_width_px(taps.placed, pixel_mm);
  return taps;
}

/// The strip that holds as much of the widest channel as the centre tap weighs, at least a pixel.
double DesignedTaps::centre_half_width_px(const PlacedTaps& placed, double pixel_mm) const {
  const double light = std::clamp(placed.weights[widest_](0, 0), 0.0, 0.99);
  const double half_width = profile_.half_width(widest_, light) / pixel_mm;
  const double farthest = placed.offsets_px.empty() ? 0.5 : placed.offsets_px.front() - 0.5;
  return std::max(0.5, std::min(half_width, farthest));
}

}  // namespace dermis
