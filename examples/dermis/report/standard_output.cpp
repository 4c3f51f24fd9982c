#include "report/standard_output.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "exr/message_text.hpp"
#include "report/progress_bar.hpp"

namespace dermis::program {
namespace {

/// Lines come from several threads.
std::atomic<int> first_error = 0;

void remember_error() {
  int none = 0;
  first_error.compare_exchange_strong(none, errno);
}

}  // namespace

void print(std::string_view lines) {
  ProgressBar::make_way();
  const std::string text = exr::escaped_lines(lines);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) remember_error();
}

std::optional<std::string> output_problem() {
  if (std::fflush(stdout) != 0) remember_error();
  if (first_error == 0 && std::ferror(stdout) == 0) return std::nullopt;
  return first_error != 0 ? std::generic_category().message(first_error) : "a write error";  // of the command line
}

}  // namespace dermis::program
