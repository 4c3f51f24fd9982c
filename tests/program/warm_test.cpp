// dermis warm, and the folder that keeps taps.
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

std::set<std::string> files_below(const std::string& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.insert(entry.path().string());
  return files;
}

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("after warm the filter compiles and fits nothing") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "a.exr", "touching", 60, 40, 3);
  fs::copy_file(folder / "a.exr", folder / "b.exr");
  for (const char* name : {"kernels", "taps", "out"}) fs::create_directory(folder / name);
  fs::permissions(folder / "taps", fs::perms::owner_all);
  const Surroundings with_kernels{.environment = "POCL_CACHE_DIR=" + (folder / "kernels")};
  const Words job = scene.camera + Words{"--material", "1=skin",      "--material",    "2=wax",        "--quality",
                                         "draft",      "--cache-dir", folder / "taps", "--bad-pixels", "error"};
  const auto runs_well = [&](const Words& words) {
    const Outcome outcome = run_program(words, with_kernels);
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    return outcome.output;
  };
  const auto is_warm_for = [&](const Words& more_to_warm, const Words& filter) {
    const std::string line = runs_well(Words{"warm", scene.path} + job + more_to_warm);
    CHECK(line.starts_with("ready after "));
    CHECK(line.find('\n') == line.size() - 1);
    CHECK(line.find("taps in " + (folder / "taps")) != std::string::npos);
    const auto kernels = files_below(folder / "kernels");
    const auto taps = files_below(folder / "taps");
    CHECK_FALSE(kernels.empty());
    CHECK_FALSE(taps.empty());
    runs_well(Words{"warm", scene.path} + job + more_to_warm);
    CHECK(files_below(folder / "kernels") == kernels);
    runs_well(filter);
    CHECK(files_below(folder / "kernels") == kernels);
    CHECK(files_below(folder / "taps") == taps);
  };
  is_warm_for({}, Words{"filter", scene.path, "-o", folder / "out.exr"} + job);
  is_warm_for({"--reuse"}, Words{"filter", folder / "a.exr", folder / "b.exr", "--reuse", "-o", folder / "out"} + job);
}

TEST_CASE("warm needs no picture, but for what only a picture can tell") {
  const TemporaryFolder folder;
  const Words job = {"warm",          "--mm-per-unit", "1",         "--material", "1=skin", "--cache-dir",
                     folder / "taps", "--method",      "separable", "--quality",  "draft"};
  const std::string line = run_well(job);
  CHECK(line.starts_with("ready after "));
  CHECK_FALSE(files_below(folder / "taps").empty());
  CHECK(run_well(job + Words{"--threads", "1"}).starts_with("ready after "));
  check_refused(run_program(job + Words{"--reuse"}), 2, {"--reuse: got no picture, want a picture"});
  check_refused(run_program(Words{"warm", "--mm-per-unit", "1"}), 2, {"--material: got neither"});
}

TEST_CASE("taps are kept where the user's caches are, or where --cache-dir says, or nowhere") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 40, 30, 3);
  const Words info = Words{"info", scene.path, "--profile", "skin"} + scene.camera;
  const auto run_with = [&](const std::string& environment, const Words& more) {
    const Outcome outcome = run_program(info + more, {.environment = environment});
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    return outcome.output;
  };
  const std::string output = run_with("XDG_CACHE_HOME=" + (folder / "caches"), {});
  CHECK(output.find("device memory ") != std::string::npos);
  CHECK(files_below(folder / "caches/dermis").size() == 2);  // the choice, and the taps
  CHECK(run_with("XDG_CACHE_HOME=" + (folder / "caches"), {}) == output);
  CHECK(run_with({}, {"--cache-dir", folder / "named"}) == output);
  CHECK(files_below(folder / "named").size() == 2);
  CHECK(run_with("XDG_CACHE_HOME=" + (folder / "unused"), {"--cache-dir", "none"}) == output);
  CHECK_FALSE(fs::exists(folder / "unused"));
  // A cache that cannot be made is no reason not to work; one that was asked for is.
  write_bytes(folder / "file", "");
  CHECK(run_with("XDG_CACHE_HOME=" + (folder / "file"), {}) == output);
  check_refused(run_program(info + Words{"--cache-dir", folder / "file"}), 2,
                {"--cache-dir: got \"" + (folder / "file") + "\", want none, or a folder of yours"});
}
