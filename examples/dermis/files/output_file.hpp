/// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::program {

/// Throws Error(output) if no file could be written at `path`, before the work that should fill it. `argument` is
/// named.
void check_writable(std::string_view argument, const std::filesystem::path& path);

/// A file that an argument names; "-" is standard output.
struct NamedFile {
  std::string argument;
  std::string path;
};

/// Looks at the outputs that have a name. Throws Error(usage) if one takes the place of another one or of a file that
/// is `taken`, and as check_writable.
void check_outputs(std::vector<NamedFile> taken, const std::vector<NamedFile>& outputs);

/// A name beside `target` to write to. It takes the target's place on commit, else it goes.
class TemporaryFile {
 public:
  TemporaryFile(std::string_view argument, std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void commit();

 private:
  std::string argument_;
  std::filesystem::path target_;
  std::filesystem::path path_;
};

/// Writes a text file.
void write_text(std::string_view argument, const std::filesystem::path& path, std::string_view text);

/// Writes a text file, or prints the text if its name is "-"; nothing if it has no name.
void write_text_or_print(std::string_view argument, const std::string& path, std::string_view text);

}  // namespace dermis::program
