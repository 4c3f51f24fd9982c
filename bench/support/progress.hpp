// How far the work is, on stderr.
#pragma once

#include <chrono>
#include <string>

namespace dermis::bench {

/// A bar on a terminal, elsewhere a line for what is new, at most one in two seconds.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(double share, const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_terminal_;
  bool is_drawn_ = false;
  Clock::time_point last_;
};

}  // namespace dermis::bench
