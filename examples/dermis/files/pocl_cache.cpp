#include "files/pocl_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"
#include "files/kept_kernels.hpp"
#include "files/user_cache.hpp"

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

constexpr const char* variable = "POCL_CACHE_DIR";

/// The cache of this run, and the kernels that are kept from run to run.
fs::path cache;
std::optional<KeptKernels> kept;
std::string crash_mark;  ///< as a signal handler can use it
std::optional<std::string> warning;
bool has_cache = true;

/// Who else may write to a folder, or put another in its place, if anybody may. What is missing is made by this user.
std::optional<std::string> other_writer(const fs::path& folder) {
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (error) return error.message();
  fs::path part;
  for (const fs::path& name : resolved) {
    part /= name;
    struct stat its = {};
    if (::stat(part.c_str(), &its) != 0) return std::nullopt;
    if (its.st_uid != ::geteuid() && its.st_uid != 0) return fmt::format("user {} owns {}", its.st_uid, part.string());
    // In a folder as /tmp nobody may rename what is another's.
    const mode_t others = part == resolved ? S_IWGRP | S_IWOTH : (its.st_mode & S_ISVTX) != 0 ? 0 : S_IWOTH;
    if ((its.st_mode & others) != 0) return fmt::format("others may write to {}", part.string());
  }
  return std::nullopt;
}

void make_private(const fs::path& folder) {
  std::error_code ignored;
  if (folder.has_parent_path() && !fs::exists(folder.parent_path(), ignored) && folder != folder.parent_path())
    make_private(folder.parent_path());
  ::mkdir(folder.c_str(), S_IRWXU);
}

/// A lock on a folder, which ends with it or with the process; false if it cannot be had.
class Lock {
 public:
  Lock(const fs::path& folder, int operation) : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    is_held_ = file_ >= 0 && ::flock(file_, operation) == 0;
  }
  ~Lock() {
    if (file_ >= 0) ::close(file_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  explicit operator bool() const { return is_held_; }

 private:
  int file_;
  bool is_held_;
};

/// What the system says of a file of `bytes` in a folder; 0 if there is room for it.
int error_of_writing(const fs::path& folder, std::size_t bytes) {
  std::string name = (folder / "dermis-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) return errno;
  const int error = posix_fallocate(file, 0, static_cast<off_t>(bytes));
  close(file);
  unlink(name.c_str());
  return error;
}

constexpr std::size_t room_bytes = std::size_t{4} << 20;  // more than the largest kernel takes

/// Why the folder is no place for a cache, else nothing.
std::optional<std::string> problem_of(const fs::path& folder) {
  if (folder.empty()) return "there is neither HOME nor XDG_CACHE_HOME";
  make_private(folder);
  if (auto problem = other_writer(folder)) return problem;
  if (const int error = error_of_writing(folder, room_bytes))
    return fmt::format("{}: {}", folder.string(), std::generic_category().message(error));
  return std::nullopt;
}

constexpr std::string_view run_prefix = "run-";
constexpr const char* crashed = "crashed";

/// A folder of that many kept kernels is there for each run; those of runs that are over, by a signal or a crash, go.
/// What a run that has crashed has used is dropped.
void remove_ended_runs(const fs::path& folder) {
  std::error_code error;
  int dropped = 0;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!entry.path().filename().string().starts_with(run_prefix)) continue;
    const Lock lock(entry.path(), LOCK_EX | LOCK_NB);
    if (!lock) continue;  // it is at work
    if (fs::exists(entry.path() / crashed, error)) dropped += kept->drop_used(entry.path());
    fs::remove_all(entry.path(), error);
  }
  if (dropped > 0)
    warning = fmt::format("{}: {} programs of kernels were in use in a run that has crashed: they are compiled anew",
                          folder.string(), dropped);
}

/// Makes the cache of this run, which is locked until the process ends.
bool make_cache(const std::string& name) {
  std::string made = name + "XXXXXX";
  if (::mkdtemp(made.data()) == nullptr) return false;
  static std::optional<Lock> lock;
  lock.emplace(made, LOCK_EX | LOCK_NB);
  cache = made;
  crash_mark = cache / crashed;
  ::setenv(variable, cache.c_str(), 1);
  return true;
}

}  // namespace

void choose_cache() {
  if (const char* const chosen = std::getenv(variable); chosen != nullptr && *chosen != '\0') {
    if (const auto writer = other_writer(chosen))
      warning = fmt::format("{}: {}, and so what runs here; want a folder of yours alone", variable, *writer);
    return;
  }
  const fs::path usual = user_cache().empty() ? fs::path() : user_cache() / "kernels";
  const auto problem = problem_of(usual);
  if (!usual.empty() && !other_writer(usual)) kept.emplace(usual);
  if (!problem) {
    const Lock lock(usual, LOCK_EX);  // so that no other takes a new folder for one of a run that is over
    remove_ended_runs(usual);
    has_cache = make_cache(usual / run_prefix);
  } else {
    std::error_code error;
    const fs::path temporary = fs::temp_directory_path(error);
    has_cache = !error && make_cache(temporary / "dermis-kernels-") && !other_writer(cache);
    warning = fmt::format("{}: got nothing, and {}; want a folder: what is compiled is not kept", variable, *problem);
  }
  // A name that leads nowhere keeps PoCL from its own choice.
  if (!has_cache) ::setenv(variable, "/dev/null/none", 1);
}

std::optional<std::string> fill_cache() {
  if (!has_cache)
    throw Error(ErrorCode::device, variable, "nothing, and no home or temporary folder of this user alone", "a folder");
  static bool is_filled = false;
  if (kept && !std::exchange(is_filled, true)) kept->lay_out(cache);
  return std::exchange(warning, std::nullopt);
}

void close_cache() noexcept {
  if (cache.empty()) return;
  std::error_code ignored;
  try {
    if (kept) kept->keep(cache);
  } catch (const std::exception&) {
    // What is not kept is compiled again.
  }
  fs::remove_all(cache, ignored);
}

void mark_crash() noexcept {
  if (crash_mark.empty()) return;
  const int file = ::open(crash_mark.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file >= 0) ::close(file);
}

std::optional<std::string> cache_problem() {
  const char* const folder = std::getenv(variable);
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  std::error_code made;
  fs::create_directories(folder, made);
  const int error = made ? made.value() : error_of_writing(folder, room_bytes);
  if (error == 0) return std::nullopt;
  return fmt::format("PoCL's cache {} cannot be written ({})", folder, std::generic_category().message(error));
}

}  // namespace dermis::program
