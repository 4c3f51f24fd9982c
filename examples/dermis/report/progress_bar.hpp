/// A bar on stderr that says how far a long run is.
#pragma once

#include <chrono>
#include <string>

namespace dermis::program {

/// On a terminal a bar that redraws itself and goes at the end; else, in runs longer than two seconds, a line for each
/// tenth of the work or every ten seconds.
class ProgressBar {
 public:
  /// Lines begin with the name of the program.
  explicit ProgressBar(std::string program = "dermis");
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share` of the work is done, 0..1; `what` says what is being done.
  void update(double share, const std::string& what = {});

 private:
  using Clock = std::chrono::steady_clock;

  void draw(int percent, const std::string& what);
  void print_line(int percent, const std::string& what);

  std::string program_;
  bool terminal_;
  bool drawn_ = false;
  int last_percent_ = -1;
  std::string last_what_;
  Clock::time_point start_;
  Clock::time_point last_line_;
};

}  // namespace dermis::program
