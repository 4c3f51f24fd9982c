// What a scene should look like, and how far a result is off.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/plan.hpp"
#include "measure/scene.hpp"

namespace dermis::bench {

/// The scattered light at some pixels of a frame.
struct Truth {
  std::string source;               ///< how it was computed, for people
  std::vector<std::size_t> pixels;  ///< covered ones
  std::vector<double> light = {};   ///< three values per pixel
};

/// Computes truths. For a flat scene it is the exact convolution with the profile on pixels, by FFT in double
/// precision, where the frame's edge is out of reach. For others it is the surface integral (Method::exact) over all
/// that is visible, at blocks of pixels spread over the covered part, as many as are affordable.
class TruthMaker {
 public:
  explicit TruthMaker(const Device& device) : device_(device) {}

  /// Throws Error(usage) if nothing is covered.
  Truth truth_of(const Scene& scene);

 private:
  Truth surface_integral(const Scene& scene);

  Device device_;
  std::optional<Plan> exact_;  ///< serves frames of any size
};

struct Distance {
  double rel_l2 = 0;   ///< |result - truth| / |truth| over the truth's pixels, all channels together
  double max_err = 0;  ///< the largest difference / the mean of the truth
};

/// `result`: three planes of the whole frame.
Distance distance(const std::vector<float>& result, const Truth& truth);

}  // namespace dermis::bench
