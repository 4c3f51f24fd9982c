#include "commands/filter_session.hpp"

namespace dermis::program {

void FilterSession::plan(const std::vector<Material>& materials, const FrameDescription& frames,
                         const Options& options) {
  if (plan_ && materials_ == materials && frames_ == frames && options_ == options) return;
  plan_.reset();
  plan_.emplace(device_, materials, frames, options);
  materials_ = materials;
  frames_ = frames;
  options_ = options;
}

Stats FilterSession::run(const Frame& frame, const Progress& progress) {
  return reuses_ ? plan_->run(frame, reuse_, progress) : plan_->run(frame, progress);
}

}  // namespace dermis::program
