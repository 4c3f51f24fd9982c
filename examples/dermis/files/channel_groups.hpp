/// The channels that two pictures share, in groups.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/oracle/picture.hpp"

namespace dermis::program {

/// Channels whose names differ after the last dot only.
struct ChannelGroup {
  std::string name;                   ///< without the last dot; empty for channels without one
  std::vector<std::string> channels;  ///< full names
};

/// The channels of two pictures whose names start with a prefix.
struct SharedChannels {
  std::vector<ChannelGroup> groups;  ///< in both
  std::vector<std::string> only_a;
  std::vector<std::string> only_b;
};

SharedChannels share_channels(const exr::Picture& a, const exr::Picture& b, std::string_view prefix);

/// The pixels that two windows have in common; a width or height below 1 if there are none.
exr::Window common_window(const exr::Window& a, const exr::Window& b);

/// The values of a group in a part of the data window.
oracle::Picture values_of(const exr::Picture& picture, const ChannelGroup& group, const exr::Window& window);

/// Counts the values of a channel that differ in their bits, among all of a window that both have or among those where
/// `mask` (1 channel, of the window) is not 0. All of them if the formats differ.
std::int64_t count_different_bits(const exr::Picture& a, const exr::Picture& b, const std::string& channel,
                                  const exr::Window& window, const std::optional<oracle::Picture>& mask);

}  // namespace dermis::program
