#include "exr/header.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

#include "dermis/error.hpp"
#include "exr/chunk_check.hpp"
#include "exr/header_check.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t magic_number = 20000630;
constexpr std::size_t most_attributes = 10000;
constexpr std::uint64_t largest_header_bytes = std::uint64_t{64} << 20;  // Cryptomatte manifests take a few MB

/// Reads the bytes of a header in turn, never past the end of the file or the largest header.
class HeaderReader {
 public:
  explicit HeaderReader(const fs::path& path) : path_(path), stream_(path, std::ios::binary) {
    if (!stream_) {
      throw Error(ErrorCode::input_missing, escaped(path.string()), "a file that cannot be opened", "one that can");
    }
    std::error_code error;
    file_bytes_ = fs::file_size(path, error);
    left_ = error ? 0 : std::min<std::uint64_t>(file_bytes_, largest_header_bytes);
  }

  std::uint64_t file_bytes() const { return file_bytes_; }

  std::string bytes(std::size_t count) {
    if (count > left_) damaged(path_, file_bytes_ > largest_header_bytes ? "longer than 64 MB" : "the file ends in it");
    std::string out(count, '\0');
    if (!stream_.read(out.data(), static_cast<std::streamsize>(count))) damaged(path_, "the file ends in it");
    left_ -= count;
    position_ += count;
    return out;
  }

  std::uint64_t position() const { return position_; }

  std::uint32_t u32() { return little_endian(bytes(4)); }

  std::string text() {
    std::string out;
    for (char c = bytes(1)[0]; c != '\0'; c = bytes(1)[0]) {
      if (out.size() == max_name) damaged(path_, "a name longer than 255");
      out += c;
    }
    return out;
  }

 private:
  const fs::path& path_;
  std::ifstream stream_;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t left_ = 0;
  std::uint64_t position_ = 0;
};

void check_flags(const fs::path& path, std::uint32_t flags) {
  if ((flags & 0xFF) != 2) refuse(path, "OpenEXR version " + std::to_string(flags & 0xFF), "version 2");
  if ((flags & deep_flag) != 0) refuse(path, "a deep picture", "a flat one");
}

/// The attributes of the next part; none at the end of a list of parts.
Header read_part(HeaderReader& reader, const fs::path& path) {
  Header attributes;
  for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
    std::string type = reader.text();
    std::string value = reader.bytes(reader.u32());
    attributes.push_back({std::move(name), std::move(type), std::move(value)});
    if (!has_right_size(attributes.back())) damaged(path, "size of attribute " + escaped(attributes.back().name));
    if (attributes.size() > most_attributes) damaged(path, "more than 10000 attributes");
  }
  return attributes;
}

}  // namespace

std::vector<Header> read_headers(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Error(ErrorCode::input_missing, escaped(path.string()), error ? error.message() : "no such file",
                "an OpenEXR file");
  }
  if (!fs::is_regular_file(status)) refuse(path, "a folder or device", "an OpenEXR file");
  HeaderReader reader(path);
  if (reader.file_bytes() < 8 || reader.u32() != magic_number) refuse(path, "another kind of file", "an OpenEXR file");
  const std::uint32_t flags = reader.u32();
  check_flags(path, flags);

  std::vector<Header> parts = {read_part(reader, path)};
  while ((flags & multi_part_flag) != 0) {
    Header part = read_part(reader, path);
    if (part.empty()) break;
    parts.push_back(std::move(part));
    if (parts.size() > static_cast<std::size_t>(max_channels)) damaged(path, "more than 1024 parts");
  }
  const std::vector<ChunkGrid> grids = check_headers(path, parts, flags, reader.file_bytes());
  check_chunks(path, grids, reader.position(), (flags & multi_part_flag) != 0);
  return parts;
}

}  // namespace dermis::exr
