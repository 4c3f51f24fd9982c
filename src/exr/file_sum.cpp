#include "exr/file_sum.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <system_error>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {

std::string file_sum(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  auto part = std::make_unique<std::array<Bytef, 1 << 18>>();
  std::uint64_t size = 0;
  uLong sum = ::crc32(0, nullptr, 0);
  ssize_t count = file < 0 ? -1 : 1;
  while (count > 0 || (count < 0 && file >= 0 && errno == EINTR)) {
    count = ::read(file, part->data(), part->size());
    if (count <= 0) continue;
    size += static_cast<std::uint64_t>(count);
    sum = ::crc32(sum, part->data(), static_cast<uInt>(count));
  }
  const int error = errno;
  if (file >= 0) ::close(file);
  if (count < 0)
    throw Error(ErrorCode::input_missing, escaped(path.string()), std::generic_category().message(error),
                "a file that can be read");
  std::array<char, 64> text;
  const int length =
      std::snprintf(text.data(), text.size(), "%llu bytes, CRC-32 %08lx", static_cast<unsigned long long>(size), sum);
  return {text.data(), static_cast<std::size_t>(length)};
}

}  // namespace dermis::exr
