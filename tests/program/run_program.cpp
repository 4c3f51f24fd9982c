#include "program/run_program.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "commands/run.hpp"
#include "support/catch.hpp"
#include "support/failing_calls.hpp"
#include "support/temporary_folder.hpp"

namespace {

constexpr unsigned longest_run_s = 600;
constexpr std::size_t longest_call_bytes = 1 << 16;

void redirect(int file, const char* path) {
  const int opened = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (opened < 0 || dup2(opened, file) < 0) _exit(127);
  close(opened);
}

/// The words are: folder, environment, where stdout goes, where stderr goes, then the command line.
[[noreturn]] void run_here(std::vector<char*> words) {
  alarm(longest_run_s);
  redirect(STDOUT_FILENO, words[2]);
  redirect(STDERR_FILENO, words[3]);
  if (*words[0] != '\0' && chdir(words[0]) != 0) _exit(127);
  if (*words[1] != '\0') putenv(words[1]);
  words.erase(words.begin(), words.begin() + 4);
  words.push_back(nullptr);
  if (const char* const number = std::getenv(failing_call)) {
    install_failing_calls();
    fail_call(std::atoi(number));
  }
  const int code = dermis::program::run(static_cast<int>(words.size()) - 1, words.data());
  // Without exit(): a library that comes with OpenImageIO (log4cplus) starts threads when it is loaded, which a child
  // of fork() has not, and waits for them when it is unloaded.
  std::fflush(nullptr);
  _exit(code);
}

/// Forks for each call, a packet of words that end with 0, and answers with the status of waitpid().
void serve(int socket) {
  std::string call(longest_call_bytes, '\0');
  for (ssize_t size; (size = recv(socket, call.data(), call.size(), 0)) > 0;) {
    const pid_t child = fork();
    if (child == 0) {
      close(socket);
      std::vector<char*> words = {call.data()};
      for (char* at = call.data(); at + 1 < call.data() + size; ++at) {
        if (*at == '\0') words.push_back(at + 1);
      }
      run_here(std::move(words));
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return;
    send(socket, &status, sizeof(status), 0);
  }
}

int server = -1;

/// A process that has loaded the program, 260 shared libraries, and becomes a run of it whenever it forks. It is forked
/// itself before the first test, as tests start threads, which a child of fork() has not.
class Server : public Catch::TestEventListenerBase {
 public:
  using TestEventListenerBase::TestEventListenerBase;

  void testRunStarting(const Catch::TestRunInfo&) override {
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0) throw std::runtime_error("no sockets");
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) {
      close(sockets[0]);
      serve(sockets[1]);
      _exit(0);
    }
    close(sockets[1]);
    server = sockets[0];
  }
};

CATCH_REGISTER_LISTENER(Server)

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  const TemporaryFolder folder;
  std::vector<std::string> words = {surroundings.folder, surroundings.environment, folder / "stdout", folder / "stderr",
                                    "dermis"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::string call;
  for (const std::string& word : words) call.append(word.c_str(), word.size() + 1);
  int status = 0;
  if (call.size() > longest_call_bytes || send(server, call.data(), call.size(), MSG_NOSIGNAL) < 0 ||
      recv(server, &status, sizeof(status), 0) != sizeof(status)) {
    throw std::runtime_error("the program could not be run");
  }
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of_file(folder / "stdout"), {}, {}};
  std::istringstream errors(bytes_of_file(folder / "stderr"));
  for (std::string line; std::getline(errors, line);) {
    (is_input(line) ? outcome.input : outcome.errors) += line + (errors.eof() ? "" : "\n");
  }
  return outcome;
}

bool is_input(const std::string& line) {
  return line.starts_with("dermis: input: ") || (line.starts_with("dermis: ") && line.ends_with(" %")) ||
         (line.starts_with("dermis: warning: ") && line.find(", beyond the picture of ") != std::string::npos);
}

std::string run_well(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_program(arguments);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  return outcome.output;
}

void check_refused(const Outcome& outcome, int exit_code, const std::vector<std::string>& parts) {
  INFO("stderr: " << outcome.errors);
  CHECK(outcome.exit_code == exit_code);
  CHECK(outcome.output.empty());
  const std::string& error = outcome.errors;
  CHECK(error.substr(0, 15) == "dermis: error: ");
  CHECK(std::count(error.begin(), error.end(), '\n') == 1);
  for (const std::string& part : parts) {
    INFO("looking for: " << part);
    CHECK(outcome.errors.find(part) != std::string::npos);
  }
}
