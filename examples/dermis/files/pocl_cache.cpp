#include "files/pocl_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace dermis::program {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// As PoCL 3.1 looks for it (pocl_cache.c, pocl_cache_init_topdir).
fs::path cache_folder() {
  if (const std::string folder = variable("POCL_CACHE_DIR"); !folder.empty()) return folder;
  if (const std::string folder = variable("XDG_CACHE_HOME"); !folder.empty()) return fs::path(folder) / "pocl/kcache";
  if (const std::string folder = variable("HOME"); !folder.empty()) return fs::path(folder) / ".cache/pocl/kcache";
  return "/tmp/pocl/kcache";
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

std::optional<std::string> cache_problem() {
  constexpr std::size_t room_bytes = std::size_t{4} << 20;  // more than the largest kernel takes
  const fs::path folder = cache_folder();
  std::error_code made;
  fs::create_directories(folder, made);
  const int error = made ? made.value() : error_of_writing(folder, room_bytes);
  if (error == 0) return std::nullopt;
  return fmt::format("PoCL's cache {} cannot be written ({})", folder.string(), std::generic_category().message(error));
}

}  // namespace dermis::program
