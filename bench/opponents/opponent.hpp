// Something that filters a scene, ready to run.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/plan.hpp"

namespace dermis::bench {

/// One filter on one scene. It keeps its images in the layout that suits it best and leaves its result there; only
/// `run` is timed.
class Opponent {
 public:
  Opponent() = default;
  Opponent(const Opponent&) = delete;
  Opponent& operator=(const Opponent&) = delete;
  virtual ~Opponent() = default;

  virtual void reset() {}                              ///< puts back what a run writes over
  virtual void run() = 0;                              ///< returns when all is done
  virtual std::vector<float> result() = 0;             ///< of the last run: three planes
  virtual std::optional<Stats> stats() { return {}; }  ///< of the last run, if it is dermis
  virtual std::size_t scratch_bytes() { return 0; }    ///< device memory beyond the images, if it is dermis
};

}  // namespace dermis::bench
