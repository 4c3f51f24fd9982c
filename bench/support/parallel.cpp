#include "support/parallel.hpp"

#include <algorithm>
#include <thread>
#include <vector>

namespace dermis::bench {

std::size_t core_count() { return std::max(1U, std::thread::hardware_concurrency()); }

void on_all_cores(const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t workers = core_count();
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < workers; ++i) threads.emplace_back([&work, i, workers] { work(i, workers); });
  work(0, workers);
}

}  // namespace dermis::bench
