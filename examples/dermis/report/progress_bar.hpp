/// How far a long run is, for people and for farms.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <string>
#include <thread>

#include "dermis/words.hpp"

namespace dermis::program {

enum class ProgressStyle {
  automatic,  ///< a bar on a terminal, else plain
  plain,      ///< lines on stderr, for people who read a log
  percent,    ///< "Progress: 42%" on stdout, as Deadline and others look for it
  alf,        ///< "ALF_PROGRESS 42%" on stdout, as Tractor does
  openjd,     ///< "openjd_progress: 42.0" and "openjd_status: TEXT" on stdout, of Open Job Description
};

/// On a terminal a bar that goes at the end. Else lines: for farms whenever the whole percent has changed, for people
/// for each tenth of the work in runs longer than two seconds; and every ten seconds, as farms end what is silent.
class ProgressBar {
 public:
  /// Lines for people begin with the name of the program.
  explicit ProgressBar(std::string program = "dermis", ProgressStyle style = ProgressStyle::automatic);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `share` of the work is done, 0..1; `what` says what is being done.
  void update(double share, const std::string& what = {});

  /// Takes the bar off the terminal for a moment, for who prints anything else.
  static void make_way();

 private:
  using Clock = std::chrono::steady_clock;

  void tell(bool is_late);
  void draw();
  void print_line();
  void tick();

  std::string program_;
  ProgressStyle style_;
  bool has_bar_;
  bool drawn_ = false;
  bool ends_ = false;
  double share_ = 0;
  int percent_ = -1;  ///< as it was last told
  std::string what_;
  std::string last_what_;
  Clock::time_point start_;
  Clock::time_point last_;
  std::condition_variable_any wakes_;
  std::thread ticker_;
};

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::ProgressStyle>, 5>
    dermis::word_table<dermis::program::ProgressStyle> = {{{dermis::program::ProgressStyle::automatic, "auto"},
                                                           {dermis::program::ProgressStyle::plain, "plain"},
                                                           {dermis::program::ProgressStyle::percent, "percent"},
                                                           {dermis::program::ProgressStyle::alf, "alf"},
                                                           {dermis::program::ProgressStyle::openjd, "openjd"}}};
