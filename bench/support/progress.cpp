#include "support/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace dermis::bench {

Progress::Progress() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (is_drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::operator()(double share, const std::string& what) {
  const auto now = Clock::now();
  constexpr auto line_every = std::chrono::seconds(2);
  constexpr auto bar_every = std::chrono::milliseconds(50);
  if (now - last_ < (is_terminal_ ? Clock::duration(bar_every) : Clock::duration(line_every))) return;
  last_ = now;
  const int percent = static_cast<int>(std::lround(100 * std::clamp(share, 0.0, 1.0)));
  if (!is_terminal_) {
    fmt::print(stderr, "dermis-bench: {} % {}\n", percent, what);
    return;
  }
  constexpr int width = 30;
  is_drawn_ = true;
  const std::string filled(static_cast<std::size_t>(percent * width / 100), '#');
  fmt::print(stderr, "\r\033[K[{:<{}}] {:3} % {}", filled, width, percent, what);
  std::fflush(stderr);
}

}  // namespace dermis::bench
