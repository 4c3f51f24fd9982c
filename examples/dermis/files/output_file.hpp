/// The files that arguments name for results.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "exr/temporary_file.hpp"

namespace dermis::program {

using exr::check_writable;
using exr::TemporaryFile;

/// A file that an argument names; "-" is standard output.
struct NamedFile {
  std::string argument;
  std::string path;
};

/// True if both names lead to one file, by symbolic or hard links or another way of writing it; it need not be there
/// yet.
bool is_same_file(const std::string& a, const std::string& b);

/// Looks at the outputs that have a name. Throws Error(usage) if one takes the place of another one or of a file that
/// is `taken`, and as check_writable.
void check_outputs(std::vector<NamedFile> taken, const std::vector<NamedFile>& outputs);

/// Throws Error(output) that names `argument`.
void write_file(std::string_view argument, const std::filesystem::path& path, std::string_view bytes);

/// Writes a text file, or prints the text if its name is "-"; nothing if it has no name.
void write_text_or_print(std::string_view argument, const std::string& path, std::string_view text);

}  // namespace dermis::program
