#include "taps/kept/kept_files.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

namespace dermis {

namespace {

/// A file descriptor that is closed in the end.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int operator*() const { return descriptor_; }
  int release() { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
};

bool is_of_this_user_alone(const struct stat& its) {
  return its.st_uid == ::geteuid() && (its.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Folders that are missing are for this user alone.
void make_folder(const std::filesystem::path& folder) {
  if (::mkdir(folder.c_str(), S_IRWXU) == 0 || errno != ENOENT) return;
  if (!folder.has_parent_path() || folder.parent_path() == folder) return;
  make_folder(folder.parent_path());
  ::mkdir(folder.c_str(), S_IRWXU);
}

/// What stands before key and content.
struct Header {
  std::array<char, 8> magic = {'d', 'e', 'r', 'm', 'i', 's', ' ', '1'};
  std::uint64_t key_bytes = 0;
  std::uint64_t checksum = 0;  ///< of key and content
};

constexpr std::size_t digits = 16;

bool read_all(int file, std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t size = ::read(file, &bytes[done], bytes.size() - done);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    done += static_cast<std::size_t>(size);
  }
  return true;
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(file, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
  return true;
}

}  // namespace

// Each step keeps different values apart, so that no single word can change unnoticed.
std::uint64_t checksum(std::string_view bytes, std::uint64_t start) {
  constexpr std::uint64_t multiplier = 0x9e3779b97f4a7c15;
  std::uint64_t sum = start + bytes.size();
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[at], std::min(sizeof(word), bytes.size() - at));
    sum = std::rotl((sum ^ word) * multiplier, 29);
  }
  return (sum ^ (sum >> 32)) * multiplier;
}

KeptFiles::KeptFiles(const std::string& folder, std::string ending) : ending_(std::move(ending)) {
  if (folder.empty()) return;
  make_folder(folder);
  Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  struct stat its {};
  if (*opened >= 0 && ::fstat(*opened, &its) == 0 && is_of_this_user_alone(its)) folder_ = opened.release();
}

KeptFiles::~KeptFiles() {
  if (folder_ >= 0) ::close(folder_);
}

std::string KeptFiles::name_of_file(std::string_view key) const {
  const std::uint64_t hash = checksum(key);
  std::string name;
  for (int shift = 60; shift >= 0; shift -= 4) name += "0123456789abcdef"[hash >> shift & 15];
  return name.append(ending_);
}

/// Files that are being written have more behind the ending.
bool KeptFiles::is_name_of_file(std::string_view name) const {
  return name.size() >= digits + ending_.size() && name.substr(digits, ending_.size()) == ending_ &&
         name.find_first_not_of("0123456789abcdef") == digits;
}

std::vector<std::string> KeptFiles::names() const {
  std::vector<std::string> result;
  // A descriptor of its own, for it has its own place in the list of files, and closedir closes it.
  DIR* const list = ::fdopendir(::openat(folder_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (list == nullptr) return result;
  while (const dirent* const entry = ::readdir(list)) {
    if (is_name_of_file(entry->d_name)) result.emplace_back(entry->d_name);
  }
  ::closedir(list);
  return result;
}

std::optional<KeptFiles::Entry> KeptFiles::read(const std::string& name) const {
  // A link may lead anywhere, and a pipe would never open.
  const Descriptor file(::openat(folder_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat its {};
  if (*file < 0 || ::fstat(*file, &its) != 0 || !S_ISREG(its.st_mode) || !is_of_this_user_alone(its)) return {};
  const auto size = static_cast<std::uint64_t>(its.st_size);
  if (size < sizeof(Header) || size > most_bytes_of_file) return std::nullopt;
  std::string bytes(size, '\0');
  if (!read_all(*file, bytes)) return std::nullopt;
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::string_view rest = std::string_view(bytes).substr(sizeof(header));
  if (header.magic != Header{}.magic || header.key_bytes > rest.size() ||
      header.checksum != checksum(rest, header.key_bytes)) {
    return std::nullopt;
  }
  return Entry{std::string(rest.substr(0, header.key_bytes)), std::string(rest.substr(header.key_bytes))};
}

std::optional<std::string> KeptFiles::get(std::string_view key) const {
  if (!is_usable()) return std::nullopt;
  const std::string name = name_of_file(key);
  auto entry = read(name);
  if (!entry || entry->key != key) return std::nullopt;
  ::utimensat(folder_, name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);  // it was used now
  return std::move(entry->content);
}

void KeptFiles::for_each(const std::function<void(std::string_view, std::string_view)>& take) const {
  if (!is_usable()) return;
  for (const std::string& name : names()) {
    if (name.size() > digits + ending_.size()) continue;  // it is being written
    if (const auto entry = read(name); entry && name == name_of_file(entry->key)) {
      take(entry->key, entry->content);
    } else {
      ::unlinkat(folder_, name.c_str(), 0);
    }
  }
}

void KeptFiles::remove(std::string_view key) const {
  if (is_usable()) ::unlinkat(folder_, name_of_file(key).c_str(), 0);
}

void KeptFiles::put(std::string_view key, std::string_view content) const {
  if (!is_usable() || sizeof(Header) + key.size() + content.size() > most_bytes_of_file) return;
  std::string bytes(key);
  bytes += content;
  Header header;
  header.key_bytes = key.size();
  header.checksum = checksum(bytes, header.key_bytes);
  bytes.insert(0, reinterpret_cast<const char*>(&header), sizeof(header));

  const std::string name = name_of_file(key);
  std::random_device random;
  const std::string unfinished = name + "." + std::to_string(random()) + std::to_string(random());
  Descriptor file(
      ::openat(folder_, unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (*file < 0) return;
  const bool is_whole = write_all(*file, bytes) && ::close(file.release()) == 0;
  if (!is_whole || ::renameat(folder_, unfinished.c_str(), folder_, name.c_str()) != 0) {
    ::unlinkat(folder_, unfinished.c_str(), 0);
  }
  remove_longest_unused();
}

void KeptFiles::remove_longest_unused() const {
  struct File {
    std::string name;
    std::pair<std::int64_t, std::int64_t> used;  ///< seconds and nanoseconds
    std::uint64_t bytes;
  };
  constexpr std::uint64_t block = 512;
  std::vector<File> files;
  std::uint64_t sum = 0;
  for (const std::string& name : names()) {
    struct stat its {};
    if (::fstatat(folder_, name.c_str(), &its, AT_SYMLINK_NOFOLLOW) != 0) continue;
    const auto bytes =
        std::max(static_cast<std::uint64_t>(its.st_size), block * static_cast<std::uint64_t>(its.st_blocks));
    files.push_back({name, {its.st_mtim.tv_sec, its.st_mtim.tv_nsec}, bytes});
    sum += bytes;
  }
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  for (const File& file : files) {
    if (sum <= most_bytes) return;
    ::unlinkat(folder_, file.name.c_str(), 0);
    sum -= file.bytes;
  }
}

}  // namespace dermis
