// Wall clock time of something.
#pragma once

#include <chrono>

namespace dermis::bench {

template <class Work>
double time_ms(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace dermis::bench
