/// Whether the chunks of a file hold all of its pixels. OpenEXR decodes what there is: where a chunk is too short it
/// takes for pixels what its memory held before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "exr/header_check.hpp"

namespace dermis::exr {

/// Looks at the chunks of all parts, whose tables begin at byte `tables` of the file: each has to be there, in its
/// place, and of a size that its pixels can have. What NONE, RLE, ZIP and DWA hold is measured; PIZ, PXR24 and B44 do
/// so as they decode. Throws Error(input_unsupported).
void check_chunks(const std::filesystem::path& path, const std::vector<ChunkGrid>& parts, std::uint64_t tables,
                  bool has_part_numbers);

/// True for a whole stream of zlib that holds so many bytes.
bool is_zip_of(std::string_view packed, std::uint64_t wanted);

}  // namespace dermis::exr
