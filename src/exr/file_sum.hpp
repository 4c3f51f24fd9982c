/// What tells the bytes of a file from those of another.
#pragma once

#include <filesystem>
#include <string>

namespace dermis::exr {

/// "1320933 bytes, CRC-32 0a1b2c3d". Throws Error(input_missing) if the file cannot be read.
std::string file_sum(const std::filesystem::path& path);

}  // namespace dermis::exr
