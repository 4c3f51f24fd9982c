// The light that a filter should give, and how far a result is off.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/plan.hpp"
#include "measure/scene.hpp"

namespace dermis::bench {

/// Some of the pixels of a truth, under a name.
struct Part {
  std::string name;
  std::vector<std::size_t> places;  ///< indices into Truth::pixels
};

/// The scattered light at some pixels of a frame.
struct Truth {
  std::string source;               ///< how it was computed, for people
  std::vector<std::size_t> pixels;  ///< covered ones
  std::vector<double> light = {};   ///< three values per pixel
  std::vector<Part> parts = {};     ///< of a picture: each material, then what lies near edges
};

/// A truth counts the light within so many standard deviations of the widest Gaussian; beyond is less than 1e-5 of it.
inline constexpr double kernel_reach = 4.8;

/// Computes the truths of made scenes. For a flat scene it is the exact convolution with the profile on pixels, where
/// the frame's edge is out of reach. For others it is the surface integral (Method::exact) over all that is visible, at
/// blocks of pixels spread over the covered part, as many as are affordable.
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

/// The truth of a flat scene: the convolution of the whole plane with the profile on pixels, by FFT in double
/// precision, at the pixels that do not see the frame's edge.
Truth exact_convolution(const Scene& scene);

/// The truth of a picture: the surface integral at all pixels of its materials. `exact`: three planes of the whole
/// frame, by Method::exact.
Truth truth_of_picture(const Scene& scene, const std::vector<float>& exact);

struct Distance {
  double rel_l2 = 0;   ///< |result - truth| / |truth| over the truth's pixels, all channels together
  double max_err = 0;  ///< the largest difference / the mean of the truth
  std::vector<double> rel_l2_of_parts;
};

/// `result`: three planes of the whole frame.
Distance distance(const std::vector<float>& result, const Truth& truth);

}  // namespace dermis::bench
