#include "files/pocl_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"
#include "files/user_cache.hpp"

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

constexpr const char* variable = "POCL_CACHE_DIR";

fs::path temporary_cache;
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

/// Why the folder will not do, else nothing.
std::optional<std::string> problem_of(const fs::path& folder) {
  if (folder.empty()) return "there is neither HOME nor XDG_CACHE_HOME";
  make_private(folder);
  if (auto problem = other_writer(folder)) return problem;
  if (::access(folder.c_str(), R_OK | W_OK | X_OK) != 0)
    return fmt::format("{}: {}", folder.string(), std::generic_category().message(errno));
  return std::nullopt;
}

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

}  // namespace

void choose_cache() {
  if (const char* const chosen = std::getenv(variable); chosen != nullptr && *chosen != '\0') {
    if (const auto writer = other_writer(chosen))
      warning = fmt::format("{}: {}, and so what runs here; want a folder of yours alone", variable, *writer);
    return;
  }
  const fs::path usual = user_cache().empty() ? fs::path() : user_cache() / "kernels";
  const auto problem = problem_of(usual);
  if (!problem) {
    ::setenv(variable, usual.c_str(), 1);
    return;
  }
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "dermis-kernels-XXXXXX").string();
  if (!error && ::mkdtemp(name.data()) != nullptr) temporary_cache = name;
  has_cache = !temporary_cache.empty() && !other_writer(temporary_cache);
  // A name that leads nowhere keeps PoCL from its own choice.
  ::setenv(variable, has_cache ? temporary_cache.c_str() : "/dev/null/none", 1);
  warning = fmt::format("{}: got nothing, and {}; want a folder: kernels are compiled in each run", variable, *problem);
}

std::optional<std::string> cache_warning() {
  if (!has_cache)
    throw Error(ErrorCode::device, variable, "nothing, and no home or temporary folder of this user alone", "a folder");
  return std::exchange(warning, std::nullopt);
}

void remove_temporary_cache() noexcept {
  std::error_code ignored;
  if (!temporary_cache.empty()) fs::remove_all(temporary_cache, ignored);
}

std::optional<std::string> cache_problem() {
  constexpr std::size_t room_bytes = std::size_t{4} << 20;  // more than the largest kernel takes
  const char* const folder = std::getenv(variable);
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  std::error_code made;
  fs::create_directories(folder, made);
  const int error = made ? made.value() : error_of_writing(folder, room_bytes);
  if (error == 0) return std::nullopt;
  return fmt::format("PoCL's cache {} cannot be written ({})", folder, std::generic_category().message(error));
}

}  // namespace dermis::program
