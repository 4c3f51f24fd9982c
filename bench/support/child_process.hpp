// Another process, to talk to line by line.
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dermis::bench {

/// A program whose standard input and output are held here. Its standard error is this one's unless it is silent.
class ChildProcess {
 public:
  struct Program {
    std::string path;
    std::vector<std::string> arguments = {};
    std::map<std::string, std::string> environment = {};  ///< beside that of this process
    bool is_silent = false;                               ///< without standard error
  };

  /// Throws Error(device) if there is no process to be had. A program that cannot be run ends with status 127.
  explicit ChildProcess(const Program& program);
  /// Closes its input and waits for its end.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void send(const std::string& line);
  /// Waits for the next line that it prints; none if it has ended.
  std::optional<std::string> read_line();
  /// Waits for its end, and returns the status of waitpid.
  int wait();

 private:
  int socket_ = -1;
  pid_t id_ = -1;
  std::string unread_;
};

}  // namespace dermis::bench
