#include "report/messages.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "exr/message_text.hpp"
#include "files/pocl_cache.hpp"
#include "report/progress_bar.hpp"

namespace dermis::program {
namespace {

/// Names of files and channels come from outside: nothing in them may break the line or steer the terminal. If nobody
/// can be told, the work goes on.
void print_line(std::string_view message) {
  constexpr std::size_t longest = 8000;
  ProgressBar::make_way();
  std::fflush(stdout);
  std::fputs(fmt::format("dermis: {}\n", exr::escaped(message, longest)).c_str(), stderr);
}

/// A device that fails may do so because PoCL cannot keep what it compiles, which it does not say.
Failure report(ErrorCode code, std::string_view file, std::string_view message) {
  std::string line(message);
  if (!file.empty() && !message.starts_with(file)) line = fmt::format("{}: {}", file, message);
  const auto problem = code == ErrorCode::device ? cache_problem() : std::nullopt;
  if (problem && line.find(*problem) == std::string::npos) line += fmt::format(" ({})", *problem);
  print_error(line);
  return {static_cast<int>(code), line};
}

}  // namespace

void Messages::begin(std::string file) {
  file_ = std::move(file);
  input_.clear();
  notes_.clear();
  warnings_.clear();
}

void Messages::input(std::string text) {
  if (said_.insert(text).second && !arguments_.quiet) print_line("input: " + text);
  input_.push_back(std::move(text));
}

void Messages::note(std::string text) {
  if (said_.insert(text).second && !arguments_.quiet) print_line("note: " + text);
  notes_.push_back(std::move(text));
}

void Messages::warn(ErrorCode code, std::string_view subject, std::string_view text) {
  if (arguments_.strict) throw Error(code, fmt::format("{}: {}", file_, subject), text, "no warning, with --strict");
  warnings_.push_back(fmt::format("{}: {}", subject, text));
  print_line(fmt::format("warning: {}: {}", file_, warnings_.back()));
}

void Messages::progress(std::string_view text) const {
  if (!arguments_.quiet) print_line(text);
}

void print_warning(std::string_view text) { print_line(fmt::format("warning: {}", text)); }

void print_error(std::string_view message) { print_line(fmt::format("error: {}", message)); }

Failure report_exception(std::string_view file) {
  try {
    throw;
  } catch (const Error& error) {
    return report(error.code(), file, error.what());
  } catch (const std::bad_alloc&) {
    return report(ErrorCode::device, file, "memory: got no more from the system, want enough for the picture");
  } catch (const std::exception& error) {
    return report(ErrorCode::device, file, error.what());
  }
}

}  // namespace dermis::program
