#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/image_library.hpp"
#include "exr/memory_limit.hpp"
#include "exr/message_text.hpp"
#include "exr/part_names.hpp"
#include "exr/picture_state.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t batch_bytes = std::size_t{64} << 20;  // read at once
// The rows of one block of PIZ, and of DWAB.
constexpr int smallest_batch_rows = 32;
constexpr int largest_batch_rows = 256;
// Of what surrounds the parts: times the pixels of the largest one, and pixels that take little memory anyhow.
constexpr std::int64_t most_around = 16;
constexpr std::int64_t little_around_px = 1 << 16;

int rows_at_once(int tile_height, std::size_t packed_row_bytes) {
  if (tile_height > 0) return tile_height;
  const std::size_t rows = batch_bytes / packed_row_bytes / smallest_batch_rows * smallest_batch_rows;
  return std::clamp(static_cast<int>(std::min<std::size_t>(rows, largest_batch_rows)), smallest_batch_rows,
                    largest_batch_rows);
}

/// Memory is touched row by row as the rows arrive, so that a small file that promises much fails before it takes much.
void read_pixels(PictureReader& reader, std::size_t part, const Packing& packing, const Area& area,
                 PixelBlock& pixels) {
  const std::size_t row_bytes = packing.pixel_bytes() * static_cast<std::size_t>(area.width);
  const int step = std::min(rows_at_once(reader.tile_height(part), row_bytes), area.rows);
  const auto packed = std::make_unique_for_overwrite<std::byte[]>(row_bytes * static_cast<std::size_t>(step));
  for (int row = 0; row < area.rows; row += step) {
    const int rows = std::min(step, area.rows - row);
    reader.read_rows(part, row, rows, packed.get());
    pixels.unpack(packing, packed.get(), {area.x, area.y + row, area.width, rows});
  }
}

std::int64_t pixels_of(const Window& window) { return std::int64_t{window.width} * window.height; }

Window around(const Window& a, const Window& b) {
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

Window overlap(const Window& a, const Window& b) {
  const int x = std::max(a.x, b.x);
  const int y = std::max(a.y, b.y);
  return {x, y, std::min(a.x + a.width, b.x + b.width) - x, std::min(a.y + a.height, b.y + b.height) - y};
}

std::string text_of(const Window& window) {
  return std::to_string(window.width) + " x " + std::to_string(window.height) + " at (" + std::to_string(window.x) +
         ", " + std::to_string(window.y) + ")";
}

/// Throws std::runtime_error if what surrounds the parts, which takes memory, is much larger than they are.
void check_parts(const std::vector<PartDescription>& parts, const Window& whole) {
  std::int64_t largest = 0;
  for (const PartDescription& part : parts) largest = std::max(largest, pixels_of(part.data));
  if (std::max(whole.width, whole.height) > max_side_px ||
      pixels_of(whole) > std::max(most_around * largest, little_around_px))
    throw std::runtime_error("parts far from each other, all within " + text_of(whole));
}

std::vector<PartDescription> descriptions_of(const PictureReader& reader) {
  std::vector<PartDescription> parts;
  for (std::size_t part = 0; part < reader.parts(); ++part) parts.push_back(reader.description(part));
  return parts;
}

Window around(const std::vector<PartDescription>& parts) {
  Window whole = parts.front().data;
  for (const PartDescription& part : parts) whole = around(whole, part.data);
  return whole;
}

/// The parts that a file describes, with their channels under the names that they have in the picture.
std::vector<Part> parts_of(const PictureReader& reader) {
  std::vector<PartDescription> descriptions = descriptions_of(reader);
  const std::vector<std::vector<std::string>> names = names_in_picture(descriptions);
  std::vector<Part> parts;
  for (std::size_t p = 0; p < descriptions.size(); ++p) {
    Part part{std::move(descriptions[p]), {}};
    for (std::size_t c = 0; c < names[p].size(); ++c)
      part.channels.push_back({names[p][c], part.description.channels[c].name});
    parts.push_back(std::move(part));
  }
  return parts;
}

/// What the pixels of a picture take, however few bytes its file has.
std::uint64_t bytes_of(const std::vector<Part>& parts, const Window& whole) {
  std::uint64_t pixel_bytes = 0;
  for (const Part& part : parts) {
    for (const ChannelName& channel : part.description.channels) pixel_bytes += dermis::bytes_of(channel.format);
  }
  return pixel_bytes * static_cast<std::uint64_t>(pixels_of(whole));
}

PixelBlock block_of(const std::vector<Part>& parts, const Window& whole, std::size_t room) {
  std::vector<ChannelName> channels;
  bool is_full = true;
  for (const Part& part : parts) {
    is_full = is_full && part.description.data == whole;
    for (std::size_t c = 0; c < part.channels.size(); ++c)
      channels.push_back({part.channels[c].name, part.description.channels[c].format});
  }
  PixelBlock block(whole.width, whole.height, channels, room);
  if (!is_full) block.clear();
  return block;
}

/// The attributes of all parts, each name once: that of the first part that has it.
Header merged(const std::vector<Header>& headers) {
  Header all;
  std::set<std::string_view> names;
  for (const Header& header : headers) {
    for (const HeaderAttribute& attribute : header) {
      if (names.insert(attribute.name).second) all.push_back(attribute);
    }
  }
  return all;
}

/// The attributes in which files say which frame they are of.
constexpr std::array frame_attributes = {"Frame", "imageCounter"};

std::string text_of_attribute(const Picture& picture, const char* name) {
  if (const auto text = picture.text_attribute(name)) return *text;
  const std::vector<double> numbers = picture.number_attribute(name);
  return numbers.empty() ? std::string() : short_text(numbers.front());
}

std::string other_frame(const Picture& picture, const Picture& other, const std::filesystem::path& path) {
  for (const char* name : frame_attributes) {
    const std::string here = text_of_attribute(picture, name);
    const std::string there = text_of_attribute(other, name);
    if (!here.empty() && !there.empty() && here != there)
      return escaped(path.string()) + " is of another frame: its " + name + " is " + escaped(there) +
             ", that of the picture " + escaped(here);
  }
  return {};
}

[[noreturn]] void unreadable(const std::filesystem::path& path, std::string_view why) {
  throw Error(ErrorCode::input_unsupported, escaped(path.string()), escaped(why), "a complete OpenEXR file");
}

}  // namespace

Picture Picture::read(const std::filesystem::path& path, std::size_t room) {
  const std::vector<Header> headers = read_headers(path);
  try {
    const auto reader = image_library().open(path, headers);
    const Window whole = around(descriptions_of(*reader));
    check_parts(descriptions_of(*reader), whole);
    std::vector<Part> parts = parts_of(*reader);
    Picture picture(whole, parts.front().description.display);
    State& state = *picture.state_;
    require_memory(escaped(path.string()), bytes_of(parts, whole));
    state.pixels = block_of(parts, whole, room);
    std::size_t first = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto its = state.pixels.channels().subspan(first, parts[p].channels.size());
      read_pixels(*reader, p, Packing(its), state.area_of(parts[p].description.data), state.pixels);
      first += its.size();
      parts[p].description.channels.clear();
    }
    state.parts = std::move(parts);
    state.header = merged(headers);
    return picture;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    unreadable(path, error.what());
  }
}

std::string Picture::join(const std::filesystem::path& path) {
  const std::string prefix = path.string() + ':';
  const bool is_there = std::any_of(channels().begin(), channels().end(),
                                    [&](const Channel& channel) { return channel.name.starts_with(prefix); });
  if (is_there) return {};
  const Picture other = read(path);
  if (other.display_window() != display_window()) {
    throw Error(ErrorCode::input_unsupported, escaped(path.string()),
                "a display window of " + text_of(other.display_window()), text_of(display_window()));
  }
  Part part = other.state_->parts.front();
  part.is_written = false;
  part.channels.clear();
  std::vector<ChannelName> more;
  for (const Channel& channel : other.channels()) {
    more.push_back({prefix + channel.name, channel.format});
    part.channels.push_back({prefix + channel.name, channel.name});
  }
  if (channels().size() + more.size() > static_cast<std::size_t>(max_channels))
    throw Error(ErrorCode::input_unsupported, escaped(path.string()), std::to_string(more.size()) + " more channels",
                "at most " + std::to_string(max_channels) + " in all");
  const std::size_t first = channels().size();
  state_->pixels.add(more);
  state_->parts.push_back(std::move(part));

  const Packing from(other.channels());
  const Packing to(channels().subspan(first));
  std::string difference = other_frame(*this, other, path);
  const Window shared = overlap(data_window(), other.data_window());
  if (shared.width <= 0 || shared.height <= 0) return difference;
  std::vector<std::byte> row(from.pixel_bytes() * static_cast<std::size_t>(shared.width));
  Area theirs = other.state_->area_of(shared);
  Area ours = state_->area_of(shared);
  theirs.rows = ours.rows = 1;
  for (int y = 0; y < shared.height; ++y, ++theirs.y, ++ours.y) {
    other.state_->pixels.pack(from, row.data(), theirs);
    state_->pixels.unpack(to, row.data(), ours);
  }
  return difference;
}

}  // namespace dermis::exr
