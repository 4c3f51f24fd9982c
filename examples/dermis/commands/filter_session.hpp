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

  /// Begins to open the device, which goes on while others work.
  void open();

  /// The device, which is opened if it is not yet. Throws as Device::open.
  const Device& device() {
    open();
    return opened_.get();
  }

  /// The plan of these, which is that of the picture before if nothing has changed.
  const Plan& plan(const ChosenTaps& taps, const FrameDescription& frames);

  /// Runs the plan.
  Stats run(const Frame& frame, const Progress& progress);

 private:
  DeviceArguments device_;
  std::shared_future<Device> opened_;
  bool reuses_;
  ChosenTaps taps_;
  FrameDescription frames_;
  std::optional<Plan> plan_;
  Reuse reuse_;
};

}  // namespace dermis::program
