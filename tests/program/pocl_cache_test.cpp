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
#include <vector>

#include "dermis/error.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
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

/// A home in which runs, each a process of its own, keep what they write in PoCL's cache.
struct Runs {
  TemporaryFolder folder;
  std::string kernels = folder / ".cache/dermis/kernels";

  bool run(const std::function<bool(const std::string& cache)>& is_so) const {
    return in_child([&] {
      leave_home(folder / "none");
      setenv("HOME", folder.path().c_str(), 1);
      return is_so(chosen());
    });
  }

  /// The files of the programs that are kept, and nothing else.
  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kernels)) files.push_back(entry.path());
    return files;
  }
};

constexpr const char* program_file = "/AB/CDEF/program.bc";
constexpr const char* kernel_file = "/AB/CDEF/k/1-1-1/k.so";

/// What PoCL writes of a program that it uses.
void use_program(const std::string& cache, const std::string& code = "code") {
  fs::create_directories(fs::path(cache + kernel_file).parent_path());
  write_bytes(cache + program_file, std::string(5000, 'p'));
  write_bytes(cache + kernel_file, code);
  write_bytes(cache + "/AB/CDEF/last_accessed", "");
}

bool has_program(const std::string& cache, const std::string& code = "code") {
  return bytes_of_file(cache + program_file) == std::string(5000, 'p') && bytes_of_file(cache + kernel_file) == code;
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
      const auto warning = fill_cache();
      const bool is_made = cache.starts_with(temporary) && is_private(cache) && warning && has(*warning, reason);
      close_cache();
      return is_made && !fs::exists(cache) && !fill_cache();
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
    const bool is_made = cache.starts_with(folder / ".cache/dermis/kernels/run-") && is_private(cache);
    close_cache();
    return is_made && !fs::exists(cache) && !fill_cache();
  }));
  CHECK(in_child([&] {
    leave_home(folder / "none");
    setenv("XDG_CACHE_HOME", (folder / "caches").c_str(), 1);
    return chosen().starts_with(folder / "caches/dermis/kernels/run-") && !fill_cache();
  }));
}

TEST_CASE("a folder that others may write to is not where kernels come from", "[cache]") {
  const Places places;
  CHECK(in_child([&] {
    leave_home(places.temporary);
    setenv("HOME", places.home.c_str(), 1);
    const bool is_there = chosen().starts_with(places.kernels + "/run-") && !fill_cache();
    close_cache();
    return is_there;
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
    const auto warning = fill_cache();
    const bool is_made = cache.starts_with(places.temporary) && is_private(cache) && warning &&
                         has(*warning, "neither HOME nor XDG_CACHE_HOME");
    write_bytes(cache + "/kernel.so", "x");
    close_cache();
    return is_made && fs::is_empty(places.temporary);
  }));
  CHECK(in_child([&] {
    leave_home(places.folder / "none");
    if (!chosen().starts_with("/dev/null/")) return false;
    try {
      fill_cache();
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
    return chosen() == places.kernels && !fill_cache();
  }));
  fs::permissions(places.kernels, fs::perms::all);
  CHECK(in_child([&] {
    setenv("POCL_CACHE_DIR", places.kernels.c_str(), 1);
    const std::string cache = chosen();
    const auto warning = fill_cache();
    return cache == places.kernels && warning && has(*warning, "POCL_CACHE_DIR: others may write to " + cache);
  }));
}

TEST_CASE("kernels are kept from run to run, without what is damaged", "[cache]") {
  const Runs runs;
  const auto keep = [&](const std::string& code) {
    return runs.run([&](const std::string& cache) {
      use_program(cache, code);
      close_cache();
      return true;
    });
  };
  CHECK(keep("code"));
  REQUIRE(runs.kept().size() == 1);
  const auto holds = [&](const std::string& code) {
    return runs.run([&](const std::string& cache) {
      const bool is_there = !fill_cache() && has_program(cache, code);
      close_cache();
      return is_there;
    });
  };
  CHECK(holds("code"));
  CHECK(keep("more code"));
  CHECK(holds("more code"));

  // Any change anywhere: none of the program is there, and its file is gone.
  const std::string whole = bytes_of_file(runs.kept().front());
  Random random(9601);
  const auto place = [&] { return static_cast<std::size_t>(random.integer(0, static_cast<int>(whole.size()) - 1)); };
  for (int i = 0; i < 24; ++i) {
    std::string bytes = whole;
    if (i % 3 == 0) {
      bytes[place()] ^= static_cast<char>(1 << random.integer(0, 7));
    } else if (i % 3 == 1) {
      bytes.resize(place());
    } else {
      bytes =
          "\x7f"
          "ELF" +
          std::string(place(), 'x');
    }
    const fs::path file = runs.kept().front();
    write_bytes(file, bytes);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    CAPTURE(test_seed(), i);
    CHECK(runs.run([&](const std::string& cache) {
      const bool is_gone = !fill_cache() && !fs::exists(cache + "/AB") && !fs::exists(file);
      use_program(cache, "more code");
      close_cache();
      return is_gone;
    }));
    REQUIRE(runs.kept().size() == 1);
    CHECK(bytes_of_file(runs.kept().front()) == whole);
  }
}

TEST_CASE("what a run that crashed has used is compiled anew, and runs that were ended leave nothing", "[cache]") {
  const Runs runs;
  CHECK(runs.run([](const std::string& cache) {
    use_program(cache);
    close_cache();
    return true;
  }));
  // Ended by a signal that nobody sees.
  CHECK(runs.run([](const std::string& cache) {
    use_program(cache);
    return fs::exists(cache);
  }));
  CHECK(runs.kept().size() == 2);
  CHECK(runs.run([](const std::string& cache) {
    const bool is_there = !fill_cache() && has_program(cache);
    // Two at once: none takes the folder of the other.
    const bool is_other = in_child([&] {
      unsetenv("POCL_CACHE_DIR");
      const std::string its = chosen();
      close_cache();
      return its != cache && !fs::exists(its);
    });
    use_program(cache);
    mark_crash();
    return is_there && is_other && fs::exists(cache);
  }));
  CHECK(runs.run([](const std::string& cache) {
    const auto warning = fill_cache();
    close_cache();
    return !fs::exists(cache + "/AB") && warning && has(*warning, "1 programs of kernels were in use in a run that");
  }));
  CHECK(runs.kept().empty());
}

namespace {

/// `dermis light` in a home of its own, whose kernels are damaged from run to run.
struct KeptRun {
  TemporaryFolder folder;
  std::string home = folder / "home";
  std::string lit = folder / "lit.exr";
  std::string command = "env -u POCL_CACHE_DIR -u XDG_CACHE_HOME HOME='" + home + "' '" + DERMIS_PROGRAM + "' light '" +
                        (folder / "in.exr") + "' --lights '" + (folder / "lights.json") + "' -o '" + lit +
                        "' >/dev/null 2>'" + (folder / "errors") + "'";
  std::string expected;

  KeptRun() {
    run_well({"scene", "sphere", "-o", folder / "in.exr", "--size", "20x12", "--shadow-map", folder / "map.exr",
              "--lights", folder / "lights.json"});
    expected = run();
  }

  std::string run() const {
    fs::remove(lit);
    CHECK(std::system(command.c_str()) == 0);
    return bytes_of_file(lit);
  }

  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(home + "/.cache/dermis/kernels")) files.push_back(entry.path());
    return files;
  }

  /// Changes a file as a fault of a disk, or a hand, might.
  void damage(Random& random) const {
    const std::vector<fs::path> files = kept();
    const fs::path& file = files[static_cast<std::size_t>(random.integer(0, static_cast<int>(files.size()) - 1))];
    std::string bytes = bytes_of_file(file);
    const auto place = static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1));
    const int kind = random.integer(0, 2);
    if (kind == 0) {
      bytes[place] ^= static_cast<char>(1 << random.integer(0, 7));
    } else if (kind == 1) {
      bytes.resize(place);
    } else {
      bytes = bytes_of_file(DERMIS_PROGRAM);
    }
    write_bytes(file, bytes);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  }

  void run_damaged(int cases) const {
    Random random(9602);
    for (int i = 0; i < cases; ++i) {
      damage(random);
      CAPTURE(test_seed(), i);
      CHECK(run() == expected);
      CHECK(!kept().empty());
    }
  }
};

}  // namespace

TEST_CASE("a run whose kept kernels are damaged compiles them again", "[cache]") { KeptRun().run_damaged(1); }

TEST_CASE("200 runs whose kept kernels are damaged", "[.kept-kernels]") { KeptRun().run_damaged(200); }
