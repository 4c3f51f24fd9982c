/// Wall clock time of the steps of a command.
#pragma once

#include <chrono>

namespace dermis::program {

class Stopwatch {
 public:
  /// Milliseconds since it was made, or since the last lap.
  double lap_ms() {
    const auto now = Clock::now();
    const std::chrono::duration<double, std::milli> passed = now - start_;
    start_ = now;
    return passed.count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Milliseconds that `work` takes.
template <class Work>
double time_ms(const Work& work) {
  Stopwatch stopwatch;
  work();
  return stopwatch.lap_ms();
}

}  // namespace dermis::program
