/// The pictures of one call share a device, and a plan as long as none of them asks for another one.
#pragma once

#include <future>
#include <optional>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

class FilterSession {
 public:
  /// `reuses`: pictures take the light of what has not changed from the one before.
  FilterSession(const DeviceArguments& device, bool reuses);

  /// The device, which opens while the first picture is read. Throws as Device::open.
  const Device& device() { return device_.get(); }

  /// The plan of these, which is that of the picture before if nothing has changed.
  const Plan& plan(const ChosenTaps& taps, const FrameDescription& frames);

  /// Runs the plan.
  Stats run(const Frame& frame, const Progress& progress);

 private:
  std::shared_future<Device> device_;
  bool reuses_;
  ChosenTaps taps_;
  FrameDescription frames_;
  std::optional<Plan> plan_;
  Reuse reuse_;
};

}  // namespace dermis::program
