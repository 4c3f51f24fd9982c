/// Text files that may be anything.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::exr {

/// All of an ordinary file of text, whose name `argument` gives. Throws Error(input_missing) that says what is `wanted`
/// if there is none (a pipe would be waited for, and a device may have no end), Error(input_unsupported) if it is
/// larger than 16 MB or has a byte 0.
std::string read_text(std::string_view argument, const std::filesystem::path& path, std::string_view wanted);

}  // namespace dermis::exr
