#include "exr/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t most_bytes = std::size_t{16} << 20;

/// -1 if it is no ordinary file.
int open_ordinary(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  struct stat status = {};
  if (file < 0 || (::fstat(file, &status) == 0 && S_ISREG(status.st_mode))) return file;
  ::close(file);
  return -1;
}

}  // namespace

std::string read_text(std::string_view argument, const std::filesystem::path& path, std::string_view wanted) {
  const std::string name = escaped(path.string());
  const int file = open_ordinary(path);
  if (file < 0)
    throw Error(ErrorCode::input_missing, argument, path.empty() ? "no file name" : name + ", which cannot be read",
                wanted);
  std::string text;
  std::array<char, 1 << 16> part;
  while (text.size() <= most_bytes) {
    const ssize_t count = ::read(file, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  ::close(file);
  const auto refuse = [&](std::string_view seen, std::string_view want) {
    throw Error(ErrorCode::input_unsupported, std::string(argument) + ' ' + name, seen, want);
  };
  if (text.size() > most_bytes) refuse("more than 16 MB", "a text file of at most 16 MB");
  if (const std::size_t at = text.find('\0'); at != std::string::npos)
    refuse("a byte 0 at " + std::to_string(at), "a text file");
  return text;
}

}  // namespace dermis::exr
