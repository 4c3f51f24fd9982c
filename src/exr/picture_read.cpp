#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/image_library.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t batch_bytes = std::size_t{64} << 20;  // read at once
// The rows of one block of PIZ, and of DWAB.
constexpr int smallest_batch_rows = 32;
constexpr int largest_batch_rows = 256;

int rows_at_once(const PictureReader& reader, const PixelBlock& pixels) {
  if (reader.tile_height() > 0) return reader.tile_height();
  const std::size_t rows = batch_bytes / pixels.packed_row_bytes() / smallest_batch_rows * smallest_batch_rows;
  return std::clamp(static_cast<int>(std::min<std::size_t>(rows, largest_batch_rows)), smallest_batch_rows,
                    largest_batch_rows);
}

/// Memory is touched row by row as the rows arrive, so that a small file that promises much fails before it takes much.
void read_pixels(PictureReader& reader, PixelBlock& pixels) {
  const int step = std::min(rows_at_once(reader, pixels), pixels.height());
  const auto packed =
      std::make_unique_for_overwrite<std::byte[]>(pixels.packed_row_bytes() * static_cast<std::size_t>(step));
  for (int row = 0; row < pixels.height(); row += step) {
    const int rows = std::min(step, pixels.height() - row);
    reader.read_rows(row, rows, packed.get());
    pixels.unpack(packed.get(), row, rows);
  }
}

[[noreturn]] void unreadable(const std::filesystem::path& path, std::string_view why) {
  throw Error(ErrorCode::input_unsupported, escaped(path.string()), escaped(why), "a complete OpenEXR file");
}

}  // namespace

Picture Picture::read(const std::filesystem::path& path, std::size_t room) {
  const std::vector<HeaderAttribute> header = read_header(path);
  const ImageLibrary& library = image_library();
  try {
    const auto reader = library.open(path, header);
    const PictureDescription& found = reader->description();
    Picture picture(found.data, found.display);
    picture.state_->pixels = PixelBlock(found.data.width, found.data.height, found.channels, room);
    read_pixels(*reader, picture.state_->pixels);
    picture.state_->description = found;
    picture.state_->description.channels.clear();
    picture.state_->header = header;
    return picture;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    unreadable(path, error.what());
  }
}

}  // namespace dermis::exr
