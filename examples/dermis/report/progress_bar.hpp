/// How far a long run is, on stderr.
#pragma once

#include <chrono>

namespace dermis::program {

/// On a terminal a bar that redraws itself and goes at the end; else, in runs longer than two seconds, a line for each
/// tenth of the work or every ten seconds.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share` of the work is done, 0..1.
  void update(double share);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(int percent);
  void print_line(int percent);

  bool terminal_;
  bool drawn_ = false;
  int last_percent_ = -1;
  Clock::time_point start_;
  Clock::time_point last_line_;
};

}  // namespace dermis::program
