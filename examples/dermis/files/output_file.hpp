/// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::program {

/// Throws Error(output) if no file could be written at `path`, before the work that should fill it. `argument` is
/// named.
void check_writable(std::string_view argument, const std::filesystem::path& path);

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

}  // namespace dermis::program
