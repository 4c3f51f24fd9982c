/// The numbers of frames in the names of files.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::program {

/// A file, and the number of the frame that it is of.
struct FrameFile {
  std::string path;
  std::optional<std::int64_t> number = {};  ///< none if its name has no number
  std::string pattern = {};                 ///< that named it; empty if it was named itself
};

/// The frame of a file by the last number in its name, which is negative if a minus stands alone before it, as in
/// "shot.-005.exr".
FrameFile frame_file(std::string path);

/// Whether the name of a file, without its folder, has a place for a number: "####", or "%04d" as printf has it.
bool is_pattern(const std::string& path);

/// A pattern with the number of a frame in all of its places. Throws Error(usage) that names `argument` if the file has
/// no number. Any other path stays as it is.
std::string with_frame_number(std::string_view argument, const std::string& pattern, const FrameFile& frame);

/// The frames whose files are there, in their order.
std::vector<std::int64_t> frames_there(const std::string& pattern);

/// "1001-1010, 1012": ascending numbers, with ranges where none is missing.
std::string ranges_text(std::span<const std::int64_t> numbers);

}  // namespace dermis::program
