// A design carried out: its model is made once, its taps for any size of pixel.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "dermis/taps.hpp"
#include "taps/placement/tap_fit.hpp"
#include "taps/placement/tap_runs.hpp"
#include "taps/prediction/expected_error.hpp"

namespace dermis {

/// Taps for one size of pixel.
struct SizedTaps {
  PlacedTaps placed;
  double centre_half_width_px = 0.5;  ///< the centre stands for |x| < this
};

class DesignedTaps {
 public:
  /// The design is in range.
  DesignedTaps(const Profile& profile, const TapsDesign& design);

  /// Taps for this size of pixel. `near_px`: offsets to start the search from, or to keep, unless it is everywhere.
  SizedTaps at(double pixel_mm, Fetch fetch, Search search = Search::everywhere,
               const std::vector<double>& near_px = {}) const;

  /// The error to expect of taps that were placed for this size, over natural images.
  double predicted_rel_l2(const PlacedTaps& placed, double pixel_mm) const;

  /// The error to expect of the model itself, as if each pixel had a tap and the kernel no end.
  double model_rel_l2(double pixel_mm) const;

  /// This design with another number of taps.
  DesignedTaps with_count(int count) const;

  int count() const { return design_.count; }
  const std::vector<ModelTerm>& model() const { return model_; }
  double radius_mm() const { return radius_mm_; }
  /// The radius of one channel's own marginal.
  double radius_mm(int channel) const;

 private:
  std::array<Eigen::MatrixXd, 3> run_weights(const TapRuns& runs, double pixel_mm) const;
  SizedTaps fitted(double pixel_mm, int last_px, Fetch fetch, Search search, const std::vector<double>& near_px) const;
  double centre_half_width_px(const PlacedTaps& placed, double pixel_mm) const;
  const std::array<ChannelOnPixels, 3>& on_pixels(double pixel_mm, int last_px) const;

  Profile profile_;
  TapsDesign design_;
  int widest_;  ///< channel
  std::vector<ModelTerm> model_;
  std::array<std::vector<Gaussian>, 3> mixtures_;
  double radius_mm_ = 0;
  double worth_mm_ = 0;  ///< fitted taps do not lie farther

  /// The latest channels, which the taps of one size are fitted to, weighed with another count, and judged by.
  struct Latest {
    double pixel_mm = 0;
    int period_px = 0;
    std::unique_ptr<const std::array<ChannelOnPixels, 3>> channels;
  };
  std::shared_ptr<Latest> latest_ = std::make_shared<Latest>();  ///< shared with other counts; for one thread
};

}  // namespace dermis
