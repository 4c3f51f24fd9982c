#include "support/child_process.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "dermis/error.hpp"

namespace dermis::bench {

namespace {

[[noreturn]] void become(const ChildProcess::Program& program, int socket) {
  dup2(socket, STDIN_FILENO);
  dup2(socket, STDOUT_FILENO);
  if (program.is_silent) dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
  for (const auto& [name, value] : program.environment) setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> arguments = {const_cast<char*>(program.path.c_str())};
  for (const std::string& argument : program.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  execv(program.path.c_str(), arguments.data());
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const Program& program) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error(ErrorCode::device, program.path, "no socket", "a socket");
  }
  id_ = fork();
  if (id_ == 0) become(program, ends[1]);
  socket_ = ends[0];
  close(ends[1]);
  if (id_ < 0) {
    close(socket_);
    throw Error(ErrorCode::device, program.path, "no process", "a process");
  }
}

ChildProcess::~ChildProcess() {
  wait();
  close(socket_);
}

void ChildProcess::send(const std::string& line) {
  const std::string text = line + "\n";
  // A child that has ended shows when its answer is read.
  [[maybe_unused]] const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
}

std::optional<std::string> ChildProcess::read_line() {
  std::size_t end = 0;
  while ((end = unread_.find('\n')) == std::string::npos) {
    std::array<char, 256> part{};
    const ssize_t size = read(socket_, part.data(), part.size());
    if (size <= 0) return std::nullopt;
    unread_.append(part.data(), static_cast<std::size_t>(size));
  }
  std::string line = unread_.substr(0, end);
  unread_.erase(0, end + 1);
  return line;
}

int ChildProcess::wait() {
  if (id_ < 0) return -1;
  shutdown(socket_, SHUT_WR);
  int status = -1;
  if (waitpid(id_, &status, 0) != id_) status = -1;
  id_ = -1;
  return status;
}

}  // namespace dermis::bench
