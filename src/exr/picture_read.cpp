#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "exr/header.hpp"
#include "exr/message_text.hpp"
#include "exr/picture_state.hpp"
#include "exr/quiet_oiio.hpp"

namespace dermis::exr {
namespace {

constexpr std::size_t batch_bytes = std::size_t{64} << 20;  // read at once
// The rows of one block of PIZ, and of DWAB.
constexpr int smallest_batch_rows = 32;
constexpr int largest_batch_rows = 256;

Format format_of(OIIO::TypeDesc type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::HALF:
      return Format::f16;
    case OIIO::TypeDesc::UINT:
      return Format::u32;
    default:
      return Format::f32;
  }
}

std::vector<ChannelName> channels_of(const OIIO::ImageSpec& spec) {
  std::vector<ChannelName> channels;
  channels.reserve(static_cast<std::size_t>(spec.nchannels));
  for (int c = 0; c < spec.nchannels; ++c) {
    channels.push_back({spec.channelnames[static_cast<std::size_t>(c)], format_of(spec.channelformat(c))});
  }
  return channels;
}

bool has_attribute(const std::vector<HeaderAttribute>& header, std::string_view name) {
  return std::any_of(header.begin(), header.end(),
                     [name](const HeaderAttribute& attribute) { return attribute.name == name; });
}

/// The part of a file's description that the next file keeps: it has no channels, no tiles and no attributes that the
/// reader made up.
OIIO::ImageSpec windows_and_attributes(OIIO::ImageSpec spec, const std::vector<HeaderAttribute>& header) {
  spec.nchannels = 0;
  spec.channelnames.clear();
  spec.channelformats.clear();
  spec.alpha_channel = spec.z_channel = -1;
  if (spec.tile_width > 0 && !has_attribute(header, "envmap")) {
    spec.erase_attribute("textureformat");  // would make a mip map of it
  }
  spec.tile_width = spec.tile_height = spec.tile_depth = 0;
  for (const char* name : {"compression", "openexr:lineOrder", "openexr:levelmode", "openexr:roundingmode"}) {
    spec.erase_attribute(name);
  }
  if (!has_attribute(header, "ResolutionUnit")) spec.erase_attribute("ResolutionUnit");
  return spec;
}

int rows_at_once(const OIIO::ImageSpec& spec, const PixelBlock& pixels) {
  if (spec.tile_width > 0) return spec.tile_height;
  const std::size_t rows = batch_bytes / pixels.packed_row_bytes() / smallest_batch_rows * smallest_batch_rows;
  return std::clamp(static_cast<int>(std::min<std::size_t>(rows, largest_batch_rows)), smallest_batch_rows,
                    largest_batch_rows);
}

/// Memory is touched row by row as the rows arrive, so that a small file that promises much fails before it takes much.
bool read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, PixelBlock& pixels) {
  const int step = std::min(rows_at_once(spec, pixels), spec.height);
  const auto packed =
      std::make_unique_for_overwrite<std::byte[]>(pixels.packed_row_bytes() * static_cast<std::size_t>(step));
  for (int row = 0; row < spec.height; row += step) {
    const int rows = std::min(step, spec.height - row);
    const int y = spec.y + row;
    const bool ok = spec.tile_width > 0 ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, y + rows, 0, 1, 0,
                                                           spec.nchannels, OIIO::TypeUnknown, packed.get())
                                        : input.read_scanlines(0, 0, y, y + rows, 0, 0, spec.nchannels,
                                                               OIIO::TypeUnknown, packed.get());
    if (!ok) return false;
    pixels.unpack(packed.get(), row, rows);
  }
  return true;
}

[[noreturn]] void unreadable(const std::filesystem::path& path, std::string_view why) {
  throw Error(ErrorCode::input_unsupported, escaped(path.string()), escaped(why), "a complete OpenEXR file");
}

}  // namespace

Picture Picture::read(const std::filesystem::path& path) {
  const std::vector<HeaderAttribute> header = read_header(path);
  const Quiet quiet;
  try {
    const auto input = OIIO::ImageInput::create("openexr");
    OIIO::ImageSpec spec;
    if (!input) unreadable(path, OIIO::geterror());
    if (!input->open(path.string(), spec)) unreadable(path, input->geterror());
    Picture picture({spec.x, spec.y, spec.width, spec.height},
                    {spec.full_x, spec.full_y, spec.full_width, spec.full_height});
    picture.state_->pixels = PixelBlock(spec.width, spec.height, channels_of(spec));
    if (!read_pixels(*input, spec, picture.state_->pixels)) unreadable(path, input->geterror());
    picture.state_->compression = spec.get_string_attribute("compression", "zip");
    picture.state_->spec = windows_and_attributes(std::move(spec), header);
    return picture;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    unreadable(path, error.what());
  }
}

}  // namespace dermis::exr
