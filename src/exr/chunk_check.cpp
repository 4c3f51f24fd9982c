#include "exr/chunk_check.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <future>
#include <string>
#include <string_view>
#include <thread>

namespace dermis::exr {
namespace {

// As files number them.
constexpr std::uint8_t none = 0;
constexpr std::uint8_t rle = 1;
constexpr std::uint8_t zips = 2;
constexpr std::uint8_t zip = 3;
constexpr std::uint8_t dwaa = 8;
constexpr std::uint8_t dwab = 9;
constexpr std::array decoded = {rle, zips, zip, dwaa, dwab};  // to see what they hold

/// The most that a byte can stand for: a run of RLE takes two bytes for 128, a match of zlib two bits for 258.
constexpr std::uint64_t most_rle = 64;
constexpr std::uint64_t most_zip = 1032;
constexpr std::uint64_t furthest_byte = std::uint64_t{1} << 62;  // sums stay within what a file may have

class File {
 public:
  explicit File(const std::filesystem::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::string bytes(std::uint64_t first, std::size_t count) const {
    std::string out(count, '\0');
    for (std::size_t done = 0; done < count;) {
      const ssize_t got = ::pread(descriptor_, out.data() + done, count - done, static_cast<off_t>(first + done));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) refuse(path_, "an end before the last block of pixels", "a complete OpenEXR file");
      done += static_cast<std::size_t>(got);
    }
    return out;
  }

 private:
  const std::filesystem::path& path_;
  int descriptor_;
};

/// Runs of one byte, or bytes as they are. 0 if the last is cut.
std::uint64_t size_of_rle(std::string_view packed) {
  std::uint64_t size = 0;
  while (!packed.empty()) {
    const auto count = static_cast<std::int8_t>(packed[0]);
    const std::size_t taken = count < 0 ? static_cast<std::size_t>(-count) : 1;
    if (packed.size() < 1 + taken) return 0;
    size += count < 0 ? taken : static_cast<std::size_t>(count) + 1;
    packed.remove_prefix(1 + taken);
  }
  return size;
}

class PartCheck {
 public:
  PartCheck(const std::filesystem::path& path, const File& file, const ChunkGrid& grid, std::uint64_t table, int number)
      : path_(path), file_(file), grid_(grid), number_(number) {
    const std::string offsets = file.bytes(table, static_cast<std::size_t>(8 * grid.columns() * grid.rows()));
    for (std::size_t at = 0; at < offsets.size(); at += 8)
      offsets_.push_back(u32(offsets, at) | static_cast<std::uint64_t>(u32(offsets, at + 4)) << 32);
  }

  /// Each thread takes some of the chunks. Where there can be no more threads, one takes them all.
  void run() const {
    const bool decodes = std::find(decoded.begin(), decoded.end(), grid_.compression) != decoded.end();
    const std::size_t workers = decodes ? std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 64) : 1;
    std::vector<std::future<void>> work;
    for (std::size_t worker = 0; worker < workers; ++worker) {
      work.push_back(std::async([this, worker, workers] {
        const std::size_t end = offsets_.size() * (worker + 1) / workers;
        for (std::size_t chunk = offsets_.size() * worker / workers; chunk < end; ++chunk) check(chunk);
      }));
    }
    for (std::future<void>& part : work) part.get();
  }

 private:
  static std::uint32_t u32(std::string_view bytes, std::size_t at) { return little_endian(bytes.substr(at)); }

  [[noreturn]] void fail(std::size_t chunk, const std::string& what) const {
    refuse(path_, "block " + std::to_string(chunk) + " of pixels " + what, "a complete OpenEXR file");
  }

  /// The numbers that a chunk begins with: of its part, and of its first row or its tile.
  std::vector<std::int64_t> place_of(std::uint64_t column, std::uint64_t row) const {
    std::vector<std::int64_t> place;
    if (number_ >= 0) place.push_back(number_);
    if (grid_.has_tiles)
      place.insert(place.end(), {static_cast<std::int64_t>(column), static_cast<std::int64_t>(row), 0, 0});
    else
      place.push_back(grid_.first_row + static_cast<std::int64_t>(row * grid_.chunk_height));
    return place;
  }

  void check(std::size_t chunk) const {
    const std::uint64_t offset = offsets_[chunk];
    if (offset == 0) fail(chunk, "missing");
    if (offset > furthest_byte) fail(chunk, "beyond the end");
    const std::uint64_t column = chunk % grid_.columns();
    const std::uint64_t row = chunk / grid_.columns();
    const std::vector<std::int64_t> place = place_of(column, row);
    const std::string head = file_.bytes(offset, 4 * (place.size() + 1));
    for (std::size_t i = 0; i < place.size(); ++i)
      if (static_cast<std::int32_t>(u32(head, 4 * i)) != place[i]) fail(chunk, "in the place of another");
    const std::uint64_t width = std::min(grid_.chunk_width, grid_.width - column * grid_.chunk_width);
    const std::uint64_t height = std::min(grid_.chunk_height, grid_.height - row * grid_.chunk_height);
    const std::uint32_t stored = u32(head, 4 * place.size());
    const Wanted wanted = {width, height, width * height * grid_.pixel_bytes()};
    if (!has_pixels(offset + head.size(), stored, wanted))
      fail(chunk, "in " + std::to_string(stored) + " bytes that do not hold its " + std::to_string(wanted.bytes));
  }

  struct Wanted {
    std::uint64_t width, height, bytes;
  };

  /// What would not become smaller is stored as it is.
  bool has_pixels(std::uint64_t first, std::uint32_t stored, const Wanted& wanted) const {
    if (stored == 0 || stored > wanted.bytes) return false;
    const std::string last = file_.bytes(first + stored - 1, 1);  // or it ends before
    if (stored == wanted.bytes) return true;
    switch (grid_.compression) {
      case none:
        return false;
      case rle:
        return wanted.bytes / stored <= most_rle && size_of_rle(file_.bytes(first, stored)) == wanted.bytes;
      case zips:
      case zip:
        return is_zip_of(file_.bytes(first, stored), wanted.bytes);
      case dwaa:
      case dwab:
        return has_dwa_parts(file_.bytes(first, stored), grid_.channels, wanted.width, wanted.height);
      default:
        return true;
    }
  }

  const std::filesystem::path& path_;
  const File& file_;
  const ChunkGrid& grid_;
  int number_;  ///< of the part, if its chunks say it; else -1
  std::vector<std::uint64_t> offsets_;
};

}  // namespace

bool is_zip_of(std::string_view packed, std::uint64_t wanted) {
  if (packed.empty() || wanted / packed.size() > most_zip) return false;
  z_stream stream = {};
  if (::inflateInit(&stream) != Z_OK) return false;
  std::array<Bytef, 1 << 15> part;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::uint64_t size = 0;
  int status = Z_OK;
  while (status == Z_OK && size <= wanted) {
    stream.next_out = part.data();
    stream.avail_out = static_cast<uInt>(part.size());
    status = ::inflate(&stream, Z_NO_FLUSH);
    size += part.size() - stream.avail_out;
  }
  ::inflateEnd(&stream);
  return status == Z_STREAM_END && size == wanted;
}

void check_chunks(const std::filesystem::path& path, const std::vector<ChunkGrid>& parts, std::uint64_t tables,
                  bool has_part_numbers) {
  const File file(path);
  int number = has_part_numbers ? 0 : -1;
  for (const ChunkGrid& grid : parts) {
    PartCheck(path, file, grid, tables, number).run();
    tables += 8 * (grid.columns() * grid.rows() + grid.chunks_of_smaller_levels);
    if (has_part_numbers) ++number;
  }
}

}  // namespace dermis::exr
