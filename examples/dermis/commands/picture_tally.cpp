#include "commands/picture_tally.hpp"

#include <fmt/format.h>

namespace dermis::program {

PictureTally::PictureTally(const Shot& shot, bool keeps_going, const Messages& messages)
    : is_sequence_(shot.is_sequence), pictures_(shot.size()), keeps_going_(keeps_going), failed_(shot.missing_count) {
  for (const MissingFrames& missing : shot.missing) print_error(missing.error().what());
  if (failed_ > 0) first_code_ = static_cast<int>(ErrorCode::input_missing);
  if (pictures_ == 0)
    messages.progress(fmt::format("no picture of {} is in this chunk: there is nothing to do", shot.pictures_in_all));
}

Failure PictureTally::fail(const std::string& input) {
  Failure failure = report_exception(is_sequence_ ? input : "");
  if (failed_++ == 0) first_code_ = failure.code;
  return failure;
}

int PictureTally::finish() const {
  if (failed_ == 0) return 0;
  const std::size_t not_done = pictures_ - done_ - failed_;
  if (pictures_ > 1)
    print_error(fmt::format("{} of {} pictures failed{}", failed_, pictures_,
                            not_done > 0 ? fmt::format(", {} were not begun", not_done) : ""));
  return keeps_going_ && done_ > 0 ? some_failed : first_code_;
}

}  // namespace dermis::program
