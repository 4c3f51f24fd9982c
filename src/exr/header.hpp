/// The header of an OpenEXR file, looked at before the OpenEXR library allocates what a damaged file asks for.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace dermis::exr {

/// One attribute as it stands in the file.
struct HeaderAttribute {
  std::string name;
  std::string type;
  std::string value;
  bool operator==(const HeaderAttribute&) const = default;
};

inline constexpr int max_side_px = 65536;
inline constexpr int max_channels = 1024;
inline constexpr int max_coordinate = 1 << 29;  // sums of two stay within int
inline constexpr std::size_t max_name = 255;    // of an attribute, a type or a channel

using Header = std::vector<HeaderAttribute>;

/// The attributes of each part of a flat file that is within the limits and has all of its pixels. Throws
/// Error(input_missing) if it cannot be opened, Error(input_unsupported) otherwise.
std::vector<Header> read_headers(const std::filesystem::path& path);

}  // namespace dermis::exr
