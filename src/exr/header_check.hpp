/// The conditions under which a reader may trust a header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "exr/header.hpp"

namespace dermis::exr {

/// Throws Error(input_unsupported).
[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view seen, std::string_view wanted);
[[noreturn]] void damaged(const std::filesystem::path& path, std::string_view what);

/// The first four bytes as a number.
std::uint32_t little_endian(std::string_view bytes);

/// False if the type of the attribute has a size and its value another.
bool has_right_size(const HeaderAttribute& attribute);

/// Throws Error(input_unsupported) unless a file of these parts and so many bytes is flat, within the limits, and can
/// be complete.
void check_headers(const std::filesystem::path& path, const std::vector<Header>& parts, std::uint64_t file_bytes);

}  // namespace dermis::exr
