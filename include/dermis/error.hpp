/// The one exception type of dermis.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dermis {

/// Kinds of error. The values are the exit codes of the `dermis` program.
enum class ErrorCode {
  usage = 2,              ///< an argument is outside what is allowed
  input_missing = 3,      ///< a file that should be read is not there
  input_unsupported = 4,  ///< a file is damaged, or of a kind dermis does not read
  role_missing = 5,       ///< the frame lacks a channel or the camera that the filter needs
  output = 6,             ///< a result cannot be written
  device = 7,             ///< no OpenCL device, or it refused the work
};

/// Everything dermis throws. what() is one line: "ARGUMENT: got SEEN, want WANTED".
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string_view argument, std::string_view seen, std::string_view wanted)
      : std::runtime_error(std::string(argument) + before_seen + std::string(seen) + before_wanted +
                           std::string(wanted)),
        code_(code),
        argument_size_(argument.size()),
        seen_size_(seen.size()) {}

  ErrorCode code() const noexcept { return code_; }

  /// The parts of what(), which hold as long as the error does.
  std::string_view argument() const noexcept { return line().substr(0, argument_size_); }
  std::string_view seen() const noexcept {
    return line().substr(argument_size_ + std::string_view(before_seen).size(), seen_size_);
  }
  std::string_view wanted() const noexcept {
    return line().substr(argument_size_ + std::string_view(before_seen).size() + seen_size_ +
                         std::string_view(before_wanted).size());
  }

 private:
  static constexpr const char* before_seen = ": got ";
  static constexpr const char* before_wanted = ", want ";

  std::string_view line() const noexcept { return what(); }

  ErrorCode code_;
  std::size_t argument_size_;
  std::size_t seen_size_;
};

}  // namespace dermis
