#include "report/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"
#include "files/output_file.hpp"

namespace dermis::program {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

/// The arguments and streams of a process that reads `input` and whose output is read here.
pid_t start_gnuplot(std::string_view argument, int input, int output) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  char program[] = "gnuplot";
  char without_settings[] = "-d";  // of the user's own, which may do anything
  std::array<char*, 3> words = {program, without_settings, nullptr};
  pid_t process = -1;
  const int error = posix_spawnp(&process, program, &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw Error(ErrorCode::output, argument, reason(error), "gnuplot on the PATH");
  return process;
}

std::string read_to_end(int file) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  for (;;) {
    const ssize_t count = ::read(file, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(count));
  }
}

/// What gnuplot prints. It does not look whether its writes succeed, so that its output goes to no file.
std::string output_of_gnuplot(std::string_view argument, const std::string& script) {
  const FileInMemory input(script);
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(ErrorCode::output, argument, reason(errno), "a pipe to gnuplot");
  pid_t process = -1;
  try {
    process = start_gnuplot(argument, input.descriptor(), ends[1]);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  std::string output = read_to_end(ends[0]);
  ::close(ends[0]);
  int status = -1;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0 || output.empty())
    throw Error(ErrorCode::output, argument,
                fmt::format("exit status {} from gnuplot and {} bytes", status, output.size()), "a plot");
  return output;
}

}  // namespace

FileInMemory::FileInMemory(std::string_view bytes) : descriptor_(::memfd_create("dermis", 0)) {
  if (descriptor_ < 0) throw Error(ErrorCode::output, "memory", reason(errno), "a file in memory");
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      ::close(descriptor_);
      throw Error(ErrorCode::output, "memory", reason(error), "a file in memory");
    }
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  ::lseek(descriptor_, 0, SEEK_SET);
}

FileInMemory::~FileInMemory() { ::close(descriptor_); }

std::string FileInMemory::name() const { return fmt::format("/dev/fd/{}", descriptor_); }

void need_gnuplot(std::string_view argument) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    throw Error(ErrorCode::output, argument, "no gnuplot", "gnuplot on the PATH");
}

std::string script_string(std::string_view text) {
  std::string result(1, '\'');
  for (const char c : exr::escaped(text)) {
    if (c == '\'') result.push_back(c);
    result.push_back(c);
  }
  result.push_back('\'');
  return result;
}

void draw_figure(std::string_view argument, const std::filesystem::path& path, const FigureSize& size,
                 const std::string& script) {
  need_gnuplot(argument);
  TemporaryFile file(path, argument);
  const bool png = path.extension() == ".png" || path.extension() == ".PNG";
  file.write(output_of_gnuplot(
      argument, fmt::format("set terminal {} size {},{} {}\n", png ? "pngcairo" : "svg background 'white'",
                            size.width_px, size.height_px, size.terminal_options) +
                    script));
  file.commit();
}

}  // namespace dermis::program
