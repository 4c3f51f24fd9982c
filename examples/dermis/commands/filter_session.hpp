/// The pictures of one call share a device, and a plan as long as none of them asks for another one.
#pragma once

#include <optional>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

class FilterSession {
 public:
  /// `reuses`: pictures take the light of what has not changed from the one before.
  FilterSession(DeviceArguments device, bool reuses) : arguments_(std::move(device)), reuses_(reuses) {}

  /// The device, which is opened when it is first asked for.
  const Device& device();

  /// The plan of these, which is that of the picture before if nothing has changed.
  const Plan& plan(const ChosenTaps& taps, const FrameDescription& frames);

  /// Runs the plan.
  Stats run(const Frame& frame, const Progress& progress);

 private:
  DeviceArguments arguments_;
  std::optional<Device> device_;
  bool reuses_;
  ChosenTaps taps_;
  FrameDescription frames_;
  std::optional<Plan> plan_;
  Reuse reuse_;
};

}  // namespace dermis::program
