// The promises of the separable method under numerical stress, measured: the test asserts them, the benchmark prints
// them.
//
// | case                                        | promised                                                            |
// |---------------------------------------------|---------------------------------------------------------------------|
// | every finite case                           | no NaN or Inf comes out; each value is within the bound that the    |
// |                                             | oracle derives from float32 rounding; light that is the same        |
// |                                             | everywhere stays so within 2e-6; values leave the range of the      |
// |                                             | light by at most half of it                                         |
// | light of 1e-30 to 1e30, all or mixed        | 4e-6 relative L2 from the double oracle over the same taps          |
// | fireflies of 65504 and of 1e20              | the same                                                            |
// | negative light                              | minus what the light would give, to the bit; mixed signs: 4e-6      |
// | denormals                                   | the oracle's bound, which lets each product and sum be flushed to 0 |
// | half in, half out                           | the oracle's bound and half a unit in the last place of the half    |
// | NaN, Inf, beyond 1e32 in a pixel's light    | left out of all sums, counted in Stats::pixels_bad, and kept to the |
// |                                             | bit, zeroed or refused (Options::bad_pixels); every other pixel has |
// |                                             | the bits that it has with background there                          |
// | depth 0, negative, NaN, +-Inf, 1e-30, 1e10  | background: not counted as bad, keeps its bits, gives no light      |
// | depth that alternates from pixel to pixel   | no light at all across a distance beyond the profile's reach; 4e-6; |
// |                                             | constant light stays so within the oracle's bound                   |
// | profiles of 1e-6 to 1e6 mm                  | 4e-6                                                                |
// | kernels wider than the frame                | 4e-6                                                                |
// | kernels narrower than half a pixel          | the pixel keeps its bits                                            |
// | 1x1, 1xN, Nx1, 16384x16, 8193 wide          | 4e-6                                                                |
// | focal lengths of 1 px and of 1e6 px, a      | 4e-6                                                                |
// | principal point 1e6 units aside             |                                                                     |
// | a camera 1e6 units away                     | the oracle's bound: depth in mm is rounded to float32               |
// | every method (rank 3, exact, disc) at 1e-12 | no NaN or Inf comes out; light that is the same everywhere stays so |
// | to 1e12 mm per unit, depths of 1e-38 to     | within 1e-4                                                         |
// | 1e30, light of 1e-30 to 3e38                |                                                                     |
// | a few lit pixels on a plane, far from edges | the sum over the picture is kept to 1e-5                            |
//
// Not promised is the range where depth alternates by more than the profile reaches: a pixel whose only neighbour of
// its material lies far behind passes for a surface as long as that gap, and the corrections of ranks 2 and 3, which
// are not divided by their weights, grow with it. The table shows by how much.
//
// If the light is finite and its scale within 1e-30..1e30, 4e-6 stands for: two passes, in each about n + 3
// roundings of 6e-8 on sums of n = 17 terms, which add up like a random walk to a few 1e-7, and a factor of ten for
// the light that the corrections of rank 2 take away again. Of constant light a mean is off by (n + 1) 6e-8 = 1.1e-6 at
// most, as both its sums round alike but for a product; 2e-6 are two passes of that.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "dermis/device.hpp"

namespace dermis::bench {

/// One case. A number that does not apply is NaN.
struct StressRow {
  std::string group;  ///< a panel of the figure shows the cases of one group
  std::string name;
  double rel_l2 = std::numeric_limits<double>::quiet_NaN();    ///< from the oracle, where the oracle is sure
  double max_rel = std::numeric_limits<double>::quiet_NaN();   ///< of all values, with those that nearly cancel
  double max_ulp = std::numeric_limits<double>::quiet_NaN();   ///< in units of the last place of the output's format
  double of_bound = std::numeric_limits<double>::quiet_NaN();  ///< largest error / (the oracle's bound on it)
  double energy = std::numeric_limits<double>::quiet_NaN();    ///< relative change of constant light, or of a sum
  /// The distance by which values leave the range of the light, in units of that range.
  double overshoot = std::numeric_limits<double>::quiet_NaN();
  long non_finite = 0;  ///< values that came out where none went in
  std::string promised = {};
  std::string failure = {};  ///< which of the promises do not hold, and what was seen; empty if all do

  bool holds() const { return failure.empty(); }
};

/// Is told what is going on.
using StressProgress = std::function<void(const std::string&)>;

/// Runs every case, on random pictures from the seed, which takes some seconds.
std::vector<StressRow> stress_rows(const Device& device, std::uint32_t seed, const StressProgress& progress = {});

}  // namespace dermis::bench
