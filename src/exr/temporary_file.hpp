/// Files that appear whole or not at all, where they are to be: behind links, with the mode and owner of what they
/// replace.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::exr {

/// The file that a write to `path` makes or replaces: the one to which symbolic links lead, there yet or not.
std::filesystem::path target_of(const std::filesystem::path& path);

/// Throws Error(output) if no file could be written at `path`, for all that can be known without doing so: it is a
/// folder or a device, it has no write permission (whatever its folder allows), or its folder is not there or cannot be
/// written. The error names `argument`, or the path if that is empty.
void check_writable(std::string_view argument, const std::filesystem::path& path);

/// A new file beside the target of a path, which takes its place on `commit`; gone at the end if that has not
/// succeeded, or after remove_temporary_files. Errors name `argument`, or the path if that is empty, and say why.
class TemporaryFile {
 public:
  /// Throws as check_writable, and Error(output) if the file cannot be made.
  explicit TemporaryFile(std::filesystem::path target, std::string_view argument = {});
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// For who writes to a stream; writes that fail are remembered, and told by `fail` and `commit`.
  std::FILE* stream() const { return stream_; }

  /// Writes to the stream.
  void write(std::string_view bytes) { std::fwrite(bytes.data(), 1, bytes.size(), stream_); }

  /// For who writes to a name.
  const std::filesystem::path& path() const { return path_; }

  /// Throws Error(output): why writing to the stream has failed if it has, else `why`.
  [[noreturn]] void fail(std::string_view why) const;

  /// Brings everything to the disk and gives the file its name. Throws Error(output).
  void commit();

 private:
  static ssize_t write_to(void* file, const char* bytes, std::size_t size);
  static int seek_in(void* file, off64_t* position, int whence);

  std::string name_;  ///< in errors
  std::filesystem::path named_;
  std::filesystem::path target_;
  std::filesystem::path path_;
  int descriptor_ = -1;
  int error_ = 0;  ///< errno of the first write that failed
  int slot_ = -1;  ///< among those that remove_temporary_files knows
  std::FILE* stream_ = nullptr;
};

/// Removes the temporary files that there are. For handlers of signals that end the process: it calls nothing that such
/// a handler may not, and a file that is being renamed is either removed or in its place.
void remove_temporary_files() noexcept;

}  // namespace dermis::exr
