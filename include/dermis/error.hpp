/// The one exception type of dermis.
#pragma once

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

/// Everything dermis throws. what() is one line: "argument: got SEEN, want WANTED".
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, std::string_view argument, std::string_view seen, std::string_view wanted)
      : std::runtime_error(std::string(argument) + ": got " + std::string(seen) + ", want " + std::string(wanted)),
        code_(code) {}

  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace dermis
