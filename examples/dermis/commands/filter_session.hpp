/// What the pictures of one call share: a device, and a plan as long as nothing asks for another one.
#pragma once

#include <optional>
#include <vector>

#include "dermis/plan.hpp"

namespace dermis::program {

class FilterSession {
 public:
  /// `reuses`: pictures take the light of what has not changed from the one before.
  FilterSession(Device device, bool reuses) : device_(std::move(device)), reuses_(reuses) {}

  const Device& device() const { return device_; }

  /// Makes a plan, unless that of the picture before is the same.
  void plan(const std::vector<Material>& materials, const FrameDescription& frames, const Options& options);

  /// Runs the plan.
  Stats run(const Frame& frame, const Progress& progress);

 private:
  Device device_;
  bool reuses_;
  std::vector<Material> materials_;
  FrameDescription frames_;
  Options options_;
  std::optional<Plan> plan_;
  Reuse reuse_;
};

}  // namespace dermis::program
