/// A file that appears under its name only when it is complete.
#pragma once

#include <cstdio>
#include <filesystem>

namespace dermis::exr {

/// A new file beside `target`. Gone at the end unless `commit` succeeded.
class TemporaryFile {
 public:
  /// Throws Error(output) if it cannot be made, or if `target` is there and is no regular file.
  explicit TemporaryFile(std::filesystem::path target);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }  ///< of the temporary file
  std::FILE* stream() const { return stream_; }

  /// Brings everything to the disk and gives the file its name. Throws Error(output).
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  std::FILE* stream_ = nullptr;
};

}  // namespace dermis::exr
