// Results by key, in files of a folder, for later processes. What cannot be read or written is as if it were not there.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dermis {

/// A hash of bytes.
std::uint64_t checksum(std::string_view bytes, std::uint64_t start = 0);

/// A folder that belongs to the user of this process, and that nobody else may write to. Its files are read only if
/// the same holds for them. For several threads and processes.
class KeptFiles {
 public:
  /// Makes the folder if it is missing, for this user alone. An empty name, or a folder that is not to be trusted,
  /// keeps nothing. `ending`: of the names of its files.
  explicit KeptFiles(const std::string& folder, std::string ending = ".taps");
  ~KeptFiles();
  KeptFiles(const KeptFiles&) = delete;
  KeptFiles& operator=(const KeptFiles&) = delete;

  bool is_usable() const { return folder_ >= 0; }

  /// What was put in under an equal key, if it is there unchanged.
  std::optional<std::string> get(std::string_view key) const;

  /// Hands over all that is there unchanged, and removes what is not. None of it counts as used.
  void for_each(const std::function<void(std::string_view key, std::string_view content)>& take) const;

  void remove(std::string_view key) const;

  /// Replaces what is there. The longest unused files go, so that all together take no more than most_bytes.
  void put(std::string_view key, std::string_view content) const;

  static constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20;  ///< of all files
  static constexpr std::uint64_t most_bytes_of_file = std::uint64_t{8}
                                                      << 20;  ///< larger ones are neither kept nor read

 private:
  struct Entry {
    std::string key, content;
  };

  std::string name_of_file(std::string_view key) const;
  bool is_name_of_file(std::string_view name) const;
  std::vector<std::string> names() const;
  /// What a file holds, if it is unchanged.
  std::optional<Entry> read(const std::string& name) const;
  void remove_longest_unused() const;

  std::string ending_;
  int folder_ = -1;  ///< a file descriptor
};

}  // namespace dermis
