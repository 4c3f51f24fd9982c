#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/image_library.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"
#include "exr/temporary_file.hpp"

namespace dermis::exr {
namespace {

constexpr std::array<std::string_view, 5> lossless = {"none", "rle", "zips", "zip", "piz"};
constexpr std::array<std::string_view, 5> lossy = {"pxr24", "b44", "b44a", "dwaa", "dwab"};
constexpr int batch_rows = 256;  // the rows of the largest block that OpenEXR compresses at once

bool among(std::span<const std::string_view> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string chosen_compression(std::string_view wanted, const std::string& of_file) {
  if (wanted.empty()) return among(lossless, of_file) ? of_file : "zip";
  std::string name = lower(wanted);
  if (!among(lossless, name) && !among(lossy, name)) {
    throw Error(ErrorCode::usage, "compression", escaped(wanted),
                "none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab");
  }
  return name;
}

std::vector<Channel> channels_to_write(const Picture& picture, std::span<const std::string> names) {
  const std::span<const Channel> all = picture.channels();
  if (names.empty()) return {all.begin(), all.end()};
  for (const std::string& name : names) {
    if (picture.find(name) == nullptr)
      throw Error(ErrorCode::role_missing, "channel", escaped(name), "one of " + channel_list(picture));
  }
  std::vector<Channel> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&](const Channel& channel) {
    return std::find(names.begin(), names.end(), channel.name) != names.end();
  });
  return chosen;
}

PictureDescription description_to_write(PictureDescription description, std::span<const Channel> channels,
                                        std::string compression) {
  for (const Channel& channel : channels) description.channels.push_back({channel.name, channel.format});
  description.compression = std::move(compression);
  return description;
}

void write_pixels(PictureWriter& writer, const PixelBlock& pixels, const Packing& packing) {
  const int step = std::min(batch_rows, pixels.height());
  const auto packed = std::make_unique_for_overwrite<std::byte[]>(
      packing.pixel_bytes() * static_cast<std::size_t>(pixels.width()) * static_cast<std::size_t>(step));
  for (int row = 0; row < pixels.height(); row += step) {
    const int rows = std::min(step, pixels.height() - row);
    pixels.pack(packing, packed.get(), row, rows);
    writer.write_rows(row, rows, packed.get());
  }
  writer.close();
}

}  // namespace

void Picture::write(const std::filesystem::path& path, std::string_view compression,
                    std::span<const std::string> names) const {
  const PixelBlock& pixels = state_->pixels;
  const std::string method = chosen_compression(compression, state_->description.compression);
  if (pixels.channels().empty())
    throw Error(ErrorCode::output, escaped(path.string()), "a picture without channels", "a channel at least");
  const std::vector<Channel> channels = channels_to_write(*this, names);
  TemporaryFile file(path);
  try {
    const PictureDescription description = description_to_write(state_->description, channels, method);
    write_pixels(*image_library().create(file.stream(), description), pixels, Packing(channels));
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    file.fail(error.what());
  }
  file.commit();
}

}  // namespace dermis::exr
