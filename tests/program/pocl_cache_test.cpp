// The folder of PoCL's cache, which holds code that runs.
#include "files/pocl_cache.hpp"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "dermis/error.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using namespace dermis::program;

namespace {

/// An environment without a home, whose temporary folder is `temporary`.
void leave_home(const std::string& temporary) {
  for (const char* name : {"HOME", "XDG_CACHE_HOME", "POCL_CACHE_DIR"}) unsetenv(name);
  setenv("TMPDIR", temporary.c_str(), 1);
}

std::string chosen() {
  choose_cache();
  return getenv("POCL_CACHE_DIR");
}

bool is_private(const std::string& folder) {
  struct stat its = {};
  return lstat(folder.c_str(), &its) == 0 && S_ISDIR(its.st_mode) && (its.st_mode & 0777) == 0700 &&
         its.st_uid == geteuid();
}

/// True if it is so in a process of its own, whose environment it may change.
bool in_child(const std::function<bool()>& is_so) {
  const pid_t child = fork();
  if (child == 0) _exit(is_so() ? 0 : 1);
  int status = -1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

struct Places {
  TemporaryFolder folder;
  std::string temporary = folder / "temporary";
  std::string home = folder / "home";
  std::string kernels = home + "/.cache/dermis/kernels";

  Places() {
    fs::create_directory(temporary);
    fs::create_directories(kernels);
    fs::permissions(kernels, fs::perms::owner_all);
  }

  /// True if the user's folder is left alone, for a reason that the warning gives, and another one is used and removed.
  bool is_avoided(const std::string& reason) const {
    return in_child([&] {
      leave_home(temporary);
      setenv("HOME", home.c_str(), 1);
      const std::string cache = chosen();
      const auto warning = cache_warning();
      const bool is_made = cache.starts_with(temporary) && is_private(cache) && warning && has(*warning, reason);
      remove_temporary_cache();
      return is_made && !fs::exists(cache) && !cache_warning();
    });
  }
};

}  // namespace

TEST_CASE("kernels are kept in a folder of the user alone", "[cache]") {
  const TemporaryFolder folder;
  CHECK(in_child([&] {
    leave_home(folder / "none");
    setenv("HOME", folder.path().c_str(), 1);
    const std::string cache = chosen();
    return cache == folder / ".cache/dermis/kernels" && is_private(cache) && !cache_warning();
  }));
  CHECK(in_child([&] {
    leave_home(folder / "none");
    setenv("XDG_CACHE_HOME", (folder / "caches").c_str(), 1);
    return chosen() == folder / "caches/dermis/kernels" && !cache_warning();
  }));
}

TEST_CASE("a folder that others may write to is not where kernels come from", "[cache]") {
  const Places places;
  CHECK(in_child([&] {
    leave_home(places.temporary);
    setenv("HOME", places.home.c_str(), 1);
    return chosen() == places.kernels && !cache_warning();
  }));
  for (const auto perms : {fs::perms::group_write, fs::perms::others_write}) {
    fs::permissions(places.kernels, fs::perms::owner_all | perms);
    CHECK(places.is_avoided("others may write to " + places.kernels));
  }
  fs::permissions(places.kernels, fs::perms::owner_all);
  const std::string above = fs::path(places.kernels).parent_path();
  fs::permissions(above, fs::perms::all);
  CHECK(places.is_avoided("others may write to " + above));
  fs::permissions(above, fs::perms::owner_all);
  // A link that leads to such a folder.
  fs::create_directory(places.folder / "shared");
  fs::permissions(places.folder / "shared", fs::perms::all);
  fs::remove(places.kernels);
  fs::create_symlink(places.folder / "shared", places.kernels);
  CHECK(places.is_avoided("others may write to " + (places.folder / "shared")));
  fs::remove(places.kernels);
  write_bytes(places.kernels, "");
  CHECK(places.is_avoided(places.kernels));
  if (geteuid() != 0) return;
  fs::remove(places.kernels);
  fs::create_directory(places.kernels);
  fs::permissions(places.kernels, fs::perms::owner_all);
  REQUIRE(chown(places.kernels.c_str(), 1234, 1234) == 0);
  CHECK(places.is_avoided("user 1234 owns " + places.kernels));
}

TEST_CASE("without a home kernels are kept nowhere, and what others share is not used", "[cache]") {
  const Places places;
  CHECK(in_child([&] {
    leave_home(places.temporary);
    const std::string cache = chosen();
    const auto warning = cache_warning();
    const bool is_made = cache.starts_with(places.temporary) && is_private(cache) && warning &&
                         has(*warning, "neither HOME nor XDG_CACHE_HOME");
    write_bytes(cache + "/kernel.so", "x");
    remove_temporary_cache();
    return is_made && fs::is_empty(places.temporary);
  }));
  CHECK(in_child([&] {
    leave_home(places.folder / "none");
    if (!chosen().starts_with("/dev/null/")) return false;
    try {
      cache_warning();
    } catch (const dermis::Error& error) {
      return error.code() == dermis::ErrorCode::device && has(error.what(), "POCL_CACHE_DIR: got nothing");
    }
    return false;
  }));
  // The whole program, which leaves nothing behind and says so once.
  const std::string errors = places.folder / "errors";
  const std::string call = "env -u HOME -u XDG_CACHE_HOME -u POCL_CACHE_DIR TMPDIR='" + places.temporary + "' '" +
                           DERMIS_PROGRAM + "' devices >/dev/null 2>'" + errors + "'";
  CHECK(std::system(call.c_str()) == 0);
  const std::string said = bytes_of_file(errors);
  CHECK(said.starts_with("dermis: warning: POCL_CACHE_DIR: got nothing, and there is neither HOME"));
  CHECK(said.find('\n') == said.size() - 1);
  CHECK(fs::is_empty(places.temporary));
}

TEST_CASE("POCL_CACHE_DIR is used as it is, with a warning if others may write there", "[cache]") {
  const Places places;
  CHECK(in_child([&] {
    setenv("POCL_CACHE_DIR", places.kernels.c_str(), 1);
    return chosen() == places.kernels && !cache_warning();
  }));
  fs::permissions(places.kernels, fs::perms::all);
  CHECK(in_child([&] {
    setenv("POCL_CACHE_DIR", places.kernels.c_str(), 1);
    const std::string cache = chosen();
    const auto warning = cache_warning();
    return cache == places.kernels && warning && has(*warning, "POCL_CACHE_DIR: others may write to " + cache);
  }));
}
