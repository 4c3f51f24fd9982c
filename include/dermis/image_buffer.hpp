/// Images of OpenImageIO for a frame, without copies. For callers that have OpenImageIO; the library does not need it.
#pragma once

#include <OpenImageIO/imagebuf.h>

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/frame.hpp"

namespace dermis {

/// Where channels of a buffer lie, in the order in which they are named: {"R", "G", "B"} or
/// {"ViewLayer.Depth.Z"}. OpenEXR files have theirs in the order of the alphabet; any even spacing will do.
/// Throws Error `role_missing` for a channel that is not there, `input_unsupported` for values of a format that frames
/// do not have, for channels that are unevenly spaced, and for pixels that are in the image cache: make_writable(true)
/// or read(0, 0, true) puts them into the buffer's own memory.
inline Layout layout_of(const OIIO::ImageBuf& buffer, std::initializer_list<const char*> channels) {
  const OIIO::ImageSpec& spec = buffer.spec();
  const auto wrong = [](const std::string& argument, const std::string& seen, const std::string& wanted) {
    return Error(ErrorCode::input_unsupported, argument, seen, wanted);
  };
  if (buffer.localpixels() == nullptr)
    throw wrong("pixels of " + std::string(buffer.name()), "none in its own memory", "make_writable(true)");
  Layout layout;
  switch (spec.format.basetype) {
    case OIIO::TypeDesc::HALF:
      layout.format = Format::f16;
      break;
    case OIIO::TypeDesc::FLOAT:
      layout.format = Format::f32;
      break;
    case OIIO::TypeDesc::UINT8:
      layout.format = Format::u8;
      break;
    case OIIO::TypeDesc::UINT16:
      layout.format = Format::u16;
      break;
    case OIIO::TypeDesc::UINT32:
      layout.format = Format::u32;
      break;
    default:
      throw wrong("format of " + std::string(buffer.name()), spec.format.c_str(), "half, float, uint8, uint16 or uint");
  }
  std::vector<std::ptrdiff_t> places;
  for (const char* channel : channels) {
    const int at = spec.channelindex(channel);
    if (at < 0) throw Error(ErrorCode::role_missing, channel, "no such channel", "a channel of the buffer");
    places.push_back(at * static_cast<std::ptrdiff_t>(spec.format.size()));
  }
  layout.offset = static_cast<std::size_t>(places.front());
  layout.channel_stride = places.size() > 1 ? places[1] - places[0] : static_cast<std::ptrdiff_t>(spec.format.size());
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (places[i] - places[i - 1] != layout.channel_stride)
      throw wrong(*channels.begin(), "channels that are not evenly spaced", "the same step from each to the next");
  }
  layout.pixel_stride = static_cast<std::ptrdiff_t>(buffer.pixel_stride());
  layout.row_stride = static_cast<std::ptrdiff_t>(buffer.scanline_stride());
  return layout;
}

/// An image to read. The buffer must live, and keep its memory, until the run is done.
inline Image image_of(const OIIO::ImageBuf& buffer, std::initializer_list<const char*> channels) {
  return {.host = buffer.localpixels(), .layout = layout_of(buffer, channels)};
}

/// An image to write, which may be one that is read.
inline OutputImage output_of(OIIO::ImageBuf& buffer, std::initializer_list<const char*> channels) {
  return {.host = buffer.localpixels(), .layout = layout_of(buffer, channels)};
}

}  // namespace dermis
