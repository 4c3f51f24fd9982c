#include "copy_time.hpp"

#include <chrono>
#include <cstring>
#include <thread>

namespace dermis::bench {

Copy::Copy(std::size_t bytes, int threads) : from_(bytes / 2, std::byte{1}), to_(bytes / 2), threads_(threads) {}

double Copy::run() {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::jthread> workers;
  const std::size_t share = from_.size() / threads_;
  for (int i = 0; i < threads_; ++i) {
    workers.emplace_back(
        [this, share, begin = share * i] { std::memcpy(to_.data() + begin, from_.data() + begin, share); });
  }
  workers.clear();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace dermis::bench
