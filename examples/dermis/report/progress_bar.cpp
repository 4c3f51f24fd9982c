#include "report/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace dermis::program {

using std::chrono::seconds;

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_line_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share) {
  const int percent = static_cast<int>(std::clamp(share, 0.0, 1.0) * 100);
  if (terminal_)
    draw(percent);
  else
    print_line(percent);
}

void ProgressBar::draw(int percent) {
  constexpr int width = 40;
  if (percent == last_percent_) return;
  last_percent_ = percent;
  drawn_ = true;
  const std::string filled(static_cast<std::size_t>(percent * width / 100), '#');
  fmt::print(stderr, "\r[{:<{}}] {:3} %", filled, width, percent);
  std::fflush(stderr);
}

void ProgressBar::print_line(int percent) {
  const auto now = Clock::now();
  if (now - start_ < seconds(2)) return;
  if (percent / 10 == last_percent_ / 10 && now - last_line_ < seconds(10)) return;
  last_percent_ = percent;
  last_line_ = now;
  fmt::print(stderr, "dermis: {} %\n", percent);
}

}  // namespace dermis::program
