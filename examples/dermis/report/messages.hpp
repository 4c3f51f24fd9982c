/// What a run says on stderr: notes, warnings and errors, one line each.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/error.hpp"

namespace dermis::program {

struct MessageArguments {
  bool strict = false;  ///< a warning is an error
  bool quiet = false;   ///< neither notes nor how far a run is
};

/// The notes and warnings of a run. A note says what was chosen where nobody said so; a warning, that the result may
/// not be what was wanted. Both stand in --stats-json, too. Not for several threads at once.
class Messages {
 public:
  explicit Messages(MessageArguments arguments) : arguments_(arguments) {}

  /// What follows is about this file; `notes` and `warnings` begin anew.
  void begin(std::string file);

  /// "dermis: input: TEXT", for what was taken from a picture and by which rule. What was said of a file before is not
  /// said again of the next one.
  void input(std::string text);

  /// "dermis: note: TEXT". What was said of a file before is not said again of the next one.
  void note(std::string text);

  /// "dermis: warning: FILE: SUBJECT: TEXT". `subject` is an option, a role or a channel; with --strict this throws
  /// Error(code) that names file and subject, so warnings come before anything is written.
  void warn(ErrorCode code, std::string_view subject, std::string_view text);

  /// "dermis: TEXT": how far a run of several steps is.
  void progress(std::string_view text) const;

  /// Of the file, as printed, without the words before.
  const std::vector<std::string>& inputs() const { return input_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

  bool quiet() const { return arguments_.quiet; }

 private:
  MessageArguments arguments_;
  std::string file_;
  std::vector<std::string> input_;
  std::vector<std::string> notes_;
  std::vector<std::string> warnings_;
  std::set<std::string> said_;
};

/// "dermis: warning: TEXT", of what no file is to blame for.
void print_warning(std::string_view text);

/// "dermis: error: MESSAGE", for a run that goes on to its end.
void print_error(std::string_view message);

struct Failure {
  int code;  ///< for the end of the process
  std::string message;
};

/// Prints the exception that is being handled, with the file that it befell unless it has no name or the message begins
/// with it.
Failure report_exception(std::string_view file = {});

}  // namespace dermis::program
