/// What became of the pictures of a call, and the exit code that says it.
#pragma once

#include <cstddef>
#include <string>

#include "arguments/output_arguments.hpp"
#include "report/messages.hpp"

namespace dermis::program {

class PictureTally {
 public:
  /// The exit code if some pictures failed and others did not.
  static constexpr int some_failed = 8;

  /// Names the frames that are not there: these have failed. Says so if there is nothing to do.
  PictureTally(const Shot& shot, bool keeps_going, const Messages& messages);

  /// Whether the next picture is to be done.
  bool goes_on() const { return keeps_going_ || failed_ == 0; }

  /// For a handler of the exception that befell a picture: prints it, with the name of a picture of a sequence.
  Failure fail(const std::string& input);

  void succeed() { ++done_; }

  /// Says how many pictures failed. Returns the exit code: that of the first failure, unless the call went on and
  /// others did not fail.
  int finish() const;

 private:
  bool is_sequence_;
  std::size_t pictures_;
  bool keeps_going_;
  std::size_t failed_ = 0;
  std::size_t done_ = 0;
  int first_code_ = 0;
};

}  // namespace dermis::program
