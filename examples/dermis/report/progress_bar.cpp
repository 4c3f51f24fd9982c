#include "report/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace dermis::program {

using std::chrono::seconds;

ProgressBar::ProgressBar(std::string program)
    : program_(std::move(program)), terminal_(isatty(STDERR_FILENO) != 0), start_(Clock::now()), last_line_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share, const std::string& what) {
  const int percent = static_cast<int>(std::clamp(share, 0.0, 1.0) * 100);
  const std::string text = what.empty() ? what : " " + what;
  if (terminal_)
    draw(percent, text);
  else
    print_line(percent, text);
}

void ProgressBar::draw(int percent, const std::string& what) {
  constexpr int width = 40;
  if (percent == last_percent_ && what == last_what_) return;
  last_percent_ = percent;
  last_what_ = what;
  drawn_ = true;
  const std::string filled(static_cast<std::size_t>(percent * width / 100), '#');
  std::fputs(fmt::format("\r\033[K[{:<{}}] {:3} %{}", filled, width, percent, what).c_str(), stderr);
  std::fflush(stderr);
}

void ProgressBar::print_line(int percent, const std::string& what) {
  const auto now = Clock::now();
  if (now - start_ < seconds(2)) return;
  if (percent / 10 == last_percent_ / 10 && now - last_line_ < seconds(10)) return;
  last_percent_ = percent;
  last_line_ = now;
  std::fputs(fmt::format("{}: {} %{}\n", program_, percent, what).c_str(), stderr);
}

}  // namespace dermis::program
