#include "exr/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

namespace fs = std::filesystem;

constexpr int attempts = 16;
constexpr int most_links = 40;  // as Linux follows

[[noreturn]] void refuse(std::string_view argument, const fs::path& path, std::string_view why,
                         std::string_view wanted = "a file that can be written") {
  const std::string name = path.empty() ? "no name" : escaped(path.string());
  if (argument.empty()) throw Error(ErrorCode::output, name, why, wanted);
  throw Error(ErrorCode::output, argument, name + (why.empty() ? "" : " (" + std::string(why) + ")"), wanted);
}

std::string reason(int error) { return std::generic_category().message(error); }

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

constexpr std::string_view prefix = ".dermis-";

/// Short, so that it fits where the target's own name does; hidden, so that no "*.exr" takes it for a result.
fs::path random_name(const fs::path& target) {
  std::random_device random;
  const std::string name = std::string(prefix) + std::to_string(random()) + std::to_string(random());
  return target.parent_path() / (name + target.extension().string().substr(0, 5));
}

/// Whoever writes a temporary file holds its lock, which ends with the process, whatever ends that. False if the file
/// is somebody else's, or is gone, as remove_abandoned came first. Where there are no locks, nothing is ever abandoned.
bool lock_own(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  struct stat status = {};
  return ::fstat(descriptor, &status) != 0 || status.st_nlink > 0;
}

/// Removes the temporary files of this user that no process writes any more, as those of one that was killed; in each
/// folder once.
void remove_abandoned(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  const std::scoped_lock lock(mutex);
  std::error_code error;
  if (!seen.insert(fs::absolute(folder, error)).second) return;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix) || name.find_first_not_of("0123456789", prefix.size()) != name.find('.', 1)) continue;
    const int descriptor = ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status = {};
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid() &&
        ::flock(descriptor, LOCK_EX | LOCK_NB) == 0)
      ::unlink(entry->path().c_str());
    ::close(descriptor);
  }
}

/// The names of temporary files, where a handler of signals can read them: a name is complete as long as `used` is 2.
struct Slot {
  std::atomic<int> used = 0;  ///< 0: free, 1: being filled, 2: a name
  char path[PATH_MAX];
};
std::array<Slot, 64> slots;
static_assert(std::atomic<int>::is_always_lock_free);

/// -1 if there is none free, so that a signal would leave the file.
int remember(const fs::path& path) {
  const std::string& name = path.native();
  for (std::size_t i = 0; i < slots.size() && name.size() < PATH_MAX; ++i) {
    int unused = 0;
    if (!slots[i].used.compare_exchange_strong(unused, 1)) continue;
    std::memcpy(slots[i].path, name.c_str(), name.size() + 1);
    slots[i].used = 2;
    return static_cast<int>(i);
  }
  return -1;
}

void forget(int slot) {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].used = 0;
}

struct stat status_of(const fs::path& target) {
  struct stat status = {};
  if (::stat(target.c_str(), &status) != 0) status.st_mode = 0;
  return status;
}

/// Gives a new file the owner, as far as the process may, and the mode of the one that it will replace, if there is
/// one.
void take_after(int descriptor, const struct stat& old) {
  if (old.st_mode == 0) return;
  // Without the right to give it away the group may still be one of the caller's own.
  const bool is_owned = ::fchown(descriptor, old.st_uid, old.st_gid) == 0 ||
                        ::fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) == 0;
  static_cast<void>(is_owned);
  static_cast<void>(::fchmod(descriptor, old.st_mode & 0777));
}

}  // namespace

fs::path target_of(const fs::path& path) {
  fs::path target = path;
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(target, error); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

void check_writable(std::string_view argument, const fs::path& path) {
  std::error_code ignored;
  const fs::path target = target_of(path);
  const fs::file_status status = fs::status(target, ignored);
  if (!path.has_filename() || !target.has_filename() || fs::is_directory(status))
    refuse(argument, path, argument.empty() ? "a folder" : "", "the name of a file, not of a folder");
  if (fs::exists(status) && !fs::is_regular_file(status))
    refuse(argument, path, argument.empty() ? "a device" : "", "an ordinary file");
  const fs::path folder = folder_of(target);
  if (!fs::is_directory(folder, ignored))
    refuse(argument, path, argument.empty() ? "no folder" : "", "a file in a folder that exists");
  if (fs::exists(status)) {
    // Root may write everything: a file that nobody is meant to write is left alone nevertheless.
    const bool is_protected =
        (status.permissions() & (fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write)) ==
        fs::perms::none;
    if (is_protected || ::access(target.c_str(), W_OK) != 0)
      refuse(argument, path, is_protected ? "it is write-protected" : reason(errno));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(argument, path, reason(errno), "a file in a folder that can be written");
}

TemporaryFile::TemporaryFile(fs::path target, std::string_view argument)
    : name_(argument), named_(std::move(target)), target_(target_of(named_)) {
  check_writable(argument, named_);
  const struct stat old = status_of(target_);
  const mode_t mode = old.st_mode == 0 ? 0666 : old.st_mode & 0777;  // nobody may open it who may not open the old one
  remove_abandoned(folder_of(target_));
  for (int i = 0; i < attempts && descriptor_ < 0; ++i) {
    path_ = random_name(target_);
    slot_ = remember(path_);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor_ >= 0 && lock_own(descriptor_)) break;
    forget(std::exchange(slot_, -1));
    if (descriptor_ < 0 && errno != EEXIST) break;
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }
  if (descriptor_ < 0) refuse(name_, named_, reason(errno));
  take_after(descriptor_, old);
  // A stream of its own, since those of the C library do not keep the reason of an error.
  stream_ = ::fopencookie(this, "w", {nullptr, write_to, seek_in, nullptr});
  if (stream_ != nullptr) return;
  ::close(descriptor_);
  ::unlink(path_.c_str());
  forget(slot_);
  refuse(name_, named_, reason(ENOMEM));
}

ssize_t TemporaryFile::write_to(void* file, const char* bytes, std::size_t size) {
  auto& self = *static_cast<TemporaryFile*>(file);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::write(self.descriptor_, bytes + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      if (self.error_ == 0) self.error_ = errno;
      return 0;
    }
    done += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(size);
}

int TemporaryFile::seek_in(void* file, off64_t* position, int whence) {
  const off64_t at = ::lseek64(static_cast<TemporaryFile*>(file)->descriptor_, *position, whence);
  if (at < 0) return -1;
  *position = at;
  return 0;
}

TemporaryFile::~TemporaryFile() {
  if (stream_ != nullptr) std::fclose(stream_);
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!path_.empty()) ::unlink(path_.c_str());
  forget(slot_);
}

void TemporaryFile::fail(std::string_view why) const {
  refuse(name_, named_, error_ != 0 ? reason(error_) : escaped(why));
}

void TemporaryFile::commit() {
  const auto failed_if = [this](bool failed) {
    if (!failed) return;
    fail(reason(errno));
  };
  // Errors of earlier writes stay in ferror; OpenEXR's destructors, which write the tables, report none.
  failed_if(std::fflush(stream_) != 0 || std::ferror(stream_) != 0);
  failed_if(::fsync(descriptor_) != 0);
  failed_if(std::fclose(std::exchange(stream_, nullptr)) != 0);
  const int lock = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);  // until the file has its name
  const bool is_placed =
      ::close(std::exchange(descriptor_, -1)) == 0 && std::rename(path_.c_str(), target_.c_str()) == 0;
  const int why = errno;
  if (lock >= 0) ::close(lock);
  errno = why;
  failed_if(!is_placed);
  path_.clear();
  forget(std::exchange(slot_, -1));
}

void remove_temporary_files() noexcept {
  for (Slot& slot : slots)
    if (slot.used == 2) ::unlink(slot.path);
}

}  // namespace dermis::exr
