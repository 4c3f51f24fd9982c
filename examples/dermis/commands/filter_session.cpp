#include "commands/filter_session.hpp"

namespace dermis::program {

FilterSession::FilterSession(const DeviceArguments& device, bool reuses) : device_(device), reuses_(reuses) {}

void FilterSession::open() {
  if (!opened_.valid()) opened_ = std::async([device = device_] { return open_device(device); });
}

const Plan& FilterSession::plan(const ChosenTaps& taps, const FrameDescription& frames) {
  if (plan_ && taps_.materials == taps.materials && frames_ == frames && taps_.options == taps.options) return *plan_;
  plan_.reset();
  plan_.emplace(device(), taps.materials, frames, taps.options);
  taps_ = taps;
  frames_ = frames;
  return *plan_;
}

Stats FilterSession::run(const Frame& frame, const Progress& progress) {
  return reuses_ ? plan_->run(frame, reuse_, progress) : plan_->run(frame, progress);
}

}  // namespace dermis::program
