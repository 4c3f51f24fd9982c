// The channels of a file as OpenImageIO alone reads them, bit for bit.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <string>

#include "catch.hpp"

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

inline std::map<std::string, StoredChannel> stored_channels(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  REQUIRE(input);
  const OIIO::ImageSpec spec = input->spec();
  std::map<std::string, StoredChannel> out;
  for (int c = 0; c < spec.nchannels; ++c) {
    StoredChannel channel{spec.channelformat(c), {}};
    channel.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                          channel.type.size());
    REQUIRE(input->read_image(0, 0, c, c + 1, OIIO::TypeUnknown, channel.values.data()));
    out[spec.channelnames[static_cast<std::size_t>(c)]] = std::move(channel);
  }
  return out;
}
