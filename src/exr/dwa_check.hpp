/// Whether a chunk of DWA holds all of its pixels. It has a header of its own, whose sizes OpenEXR takes as they are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::exr {

/// A channel as a chunk stores it.
struct ChunkChannel {
  std::string name;
  std::uint32_t type;  ///< as files number it

  std::uint64_t bytes() const;  ///< of a value
};

/// True if the parts of a chunk of DWAA or DWAB that is not stored as it is are as large as these channels of so many
/// pixels need them.
bool has_dwa_parts(std::string_view chunk, const std::vector<ChunkChannel>& channels, std::uint64_t width,
                   std::uint64_t height);

}  // namespace dermis::exr
