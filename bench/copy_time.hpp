// How long the machine takes to copy memory: the unit that times are compared in.
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::bench {

/// Copies `bytes` bytes (half of them read, half written) on `threads` threads.
class Copy {
 public:
  Copy(std::size_t bytes, int threads);

  /// Milliseconds of one copy.
  double run();

 private:
  std::vector<std::byte> from_, to_;
  int threads_;
};

}  // namespace dermis::bench
