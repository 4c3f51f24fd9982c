// The channels of a file as OpenImageIO alone reads them, bit for bit.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <map>
#include <string>

#include "support/catch.hpp"

struct StoredChannel {
  OIIO::TypeDesc type;
  std::string values;
  bool operator==(const StoredChannel& other) const { return type == other.type && values == other.values; }
};

inline OIIO::ImageSpec spec_of(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  REQUIRE(input);
  return input->spec();
}

inline std::map<std::string, StoredChannel> stored_channels(const std::filesystem::path& path, int part = 0) {
  const auto input = OIIO::ImageInput::open(path.string());
  REQUIRE(input);
  const OIIO::ImageSpec spec = input->spec(part);
  std::string pixels(spec.image_bytes(true), '\0');
  REQUIRE(input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeUnknown, pixels.data()));
  std::map<std::string, StoredChannel> out;
  const std::size_t pixel_bytes = spec.pixel_bytes(true);
  std::size_t offset = 0;
  for (int c = 0; c < spec.nchannels; ++c) {
    StoredChannel& channel = out[spec.channelnames[static_cast<std::size_t>(c)]];
    channel.type = spec.channelformat(c);
    const std::size_t bytes = channel.type.size();
    for (std::size_t at = offset; at < pixels.size(); at += pixel_bytes) {
      channel.values.append(pixels, at, bytes);
    }
    offset += bytes;
  }
  return out;
}
