#include "report/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <system_error>
#include <utility>

#include "report/standard_output.hpp"

namespace dermis::program {
namespace {

using std::chrono::seconds;

constexpr seconds longest_silence = seconds(10);

/// Guards all bars, of which one may be on the terminal. Who prints a line for a bar takes it again.
std::recursive_mutex bars;
ProgressBar* bar_on_terminal = nullptr;

}  // namespace

ProgressBar::ProgressBar(std::string program, ProgressStyle style)
    : program_(std::move(program)),
      style_(style),
      has_bar_(style == ProgressStyle::automatic && isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {
  try {
    ticker_ = std::thread([this] { tick(); });
  } catch (const std::system_error&) {
    // Without a thread for it, it tells what it is told.
  }
}

ProgressBar::~ProgressBar() {
  {
    const std::lock_guard lock(bars);
    ends_ = true;
  }
  wakes_.notify_all();
  if (ticker_.joinable()) ticker_.join();
  make_way();
}

void ProgressBar::update(double share, const std::string& what) {
  const std::lock_guard lock(bars);
  share_ = std::clamp(share, 0.0, 1.0);
  what_ = what;
  tell(false);
}

void ProgressBar::make_way() {
  const std::lock_guard lock(bars);
  if (bar_on_terminal == nullptr) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  std::exchange(bar_on_terminal, nullptr)->drawn_ = false;
}

void ProgressBar::tick() {
  std::unique_lock lock(bars);
  while (!ends_) {
    wakes_.wait_for(lock, seconds(1));
    if (!ends_) tell(Clock::now() - last_ >= longest_silence);
  }
}

void ProgressBar::tell(bool is_late) {
  const int percent = static_cast<int>(share_ * 100);
  if (has_bar_) {
    if (!drawn_ || percent != percent_ || what_ != last_what_) draw();
  } else {
    const bool is_for_people = style_ == ProgressStyle::automatic || style_ == ProgressStyle::plain;
    const bool has_changed = is_for_people ? percent / 10 != percent_ / 10 && Clock::now() - start_ >= seconds(2)
                                           : percent != percent_ || what_ != last_what_;
    if (!has_changed && !is_late) return;
    print_line();
    last_ = Clock::now();
  }
  percent_ = percent;
  last_what_ = what_;
}

void ProgressBar::draw() {
  constexpr int width = 40;
  const int percent = static_cast<int>(share_ * 100);
  const std::string filled(static_cast<std::size_t>(percent * width / 100), '#');
  std::fputs(fmt::format("\r\033[K[{:<{}}] {:3} % {}", filled, width, percent, what_).c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
  bar_on_terminal = this;
}

void ProgressBar::print_line() {
  const int percent = static_cast<int>(share_ * 100);
  switch (style_) {
    case ProgressStyle::percent:
      print(fmt::format("Progress: {}%\n", percent));
      break;
    case ProgressStyle::alf:
      print(fmt::format("ALF_PROGRESS {}%\n", percent));
      break;
    case ProgressStyle::openjd:
      print(fmt::format("openjd_progress: {:.1f}\n", 100 * share_));
      if (what_ != last_what_) print(fmt::format("openjd_status: {}\n", what_));
      break;
    default:
      std::fputs(fmt::format("{}: {}{} %\n", program_, what_.empty() ? "" : what_ + ": ", percent).c_str(), stderr);
  }
  std::fflush(stdout);
}

}  // namespace dermis::program
