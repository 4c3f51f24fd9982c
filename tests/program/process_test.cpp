// The program as it is started from a shell; other tests call it in processes that have loaded it already.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

std::string quoted(const std::string& word) { return " '" + word + "'"; }

/// What the loader of shared libraries does during a run of `program`, if that ends with this code.
std::string loaded_by(const std::string& program, const std::string& call, int exit_code,
                      const std::string& more = {}) {
  const TemporaryFolder folder;
  const std::string command = more + " LD_DEBUG=files LD_DEBUG_OUTPUT='" + (folder / "loader") + "'" + quoted(program) +
                              " " + call + " >" + quoted(folder / "stdout") + " 2>" + quoted(folder / "stderr");
  const int status = std::system(command.c_str());
  INFO(call << ": " << bytes_of_file(folder / "stderr"));
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == exit_code);
  std::string text;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
    if (entry.path().filename().string().starts_with("loader")) text += bytes_of_file(entry.path());
  return text;
}

bool has_kernels(const std::string& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".so" || entry.path().extension() == ".bc") return true;
  return false;
}

}  // namespace

TEST_CASE("what needs no picture loads no image library, and what filters none compiles no kernel") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "cache");
  const std::string cache = "POCL_CACHE_DIR='" + (folder / "cache") + "'";
  for (const char* call : {"--version", "--help", "filter --help", "profiles", "taps skin", "devices"})
    CHECK(loaded_by(DERMIS_PROGRAM, call, 0, cache).find("OpenImageIO") == std::string::npos);
  CHECK(loaded_by(DERMIS_PROGRAM, "filter in.exr -o out.png", 2).find("OpenImageIO") == std::string::npos);
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 20, 10, 3);
  const std::string info =
      loaded_by(DERMIS_PROGRAM, "info --profile skin --cache-dir none" + quoted(scene.path), 0, cache);
  CHECK(info.find("libOpenImageIO") != std::string::npos);
  CHECK_FALSE(has_kernels(folder / "cache"));
}

TEST_CASE("a program without its module says so when a picture is to be read") {
  const TemporaryFolder folder;
  const std::string lonely = folder / "dermis";
  std::filesystem::copy_file(DERMIS_PROGRAM, lonely);
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 20, 10, 3);
  const std::string errors = folder / "errors";
  CHECK(std::system((quoted(lonely) + " profiles >" + quoted(folder / "stdout") + " 2>" + quoted(errors)).c_str()) ==
        0);
  CHECK(bytes_of_file(errors).empty());
  const int status = std::system((quoted(lonely) + " info" + quoted(scene.path) + " 2>" + quoted(errors)).c_str());
  CHECK(WEXITSTATUS(status) == 3);
  const std::string message = bytes_of_file(errors);
  CHECK(message.starts_with("dermis: error: image library: got "));
  CHECK(message.find("dermis_openimageio.so") != std::string::npos);
  CHECK(message.find('\n') == message.size() - 1);
}

TEST_CASE("first runs, which compile the kernels, say nothing") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 40, 30, 3);
  const std::vector<std::string> materials = {"--material", "1=skin", "--material", "2=wax"};
  const std::string map = folder / "map.exr";
  const std::string lights = folder / "lights.json";
  run_well({"scene", "sphere", "-o", folder / "sphere.exr", "--size", "30x30", "--shadow-map", map, "--lights", lights,
            "--shadow-texels", "32"});
  const MadeScene sphere{folder / "sphere.exr", {"--mm-per-unit", "1", "--material", "1=skin"}};
  std::filesystem::create_directory(folder / "cache");
  const auto run_first = [&](const std::vector<std::string>& words) {
    std::string command = "POCL_CACHE_DIR='" + (folder / "cache") + "'" + quoted(DERMIS_PROGRAM);
    for (const std::string& word : words) command += quoted(word);
    INFO(command);
    command += " >" + quoted(folder / "stdout") + " 2>" + quoted(folder / "stderr");
    CHECK(std::system(command.c_str()) == 0);
    CHECK(bytes_of_file(folder / "stdout") == "");
    std::istringstream errors(bytes_of_file(folder / "stderr"));
    for (std::string line; std::getline(errors, line);) CHECK(is_input(line));
  };
  run_first(filter_arguments(scene, folder / "out.exr", materials));
  run_first(filter_arguments(sphere, folder / "through.exr", {"--translucency", "--lights", lights}));
  run_first(filter_arguments(sphere, folder / "disc.exr", {"--method", "disc"}));
  run_first(filter_arguments(sphere, folder / "exact.exr", {"--method", "exact"}));
  run_first({"light", sphere.path, "-o", folder / "lit.exr", "--lights", lights});
  run_first({"texture", sphere.path, "-o", folder / "texture.exr", "--profile", "skin", "--mm-per-texel", "1"});
  run_well(filter_arguments(scene, folder / "again.exr", materials));
  CHECK(relative_l2(folder / "again.exr", folder / "out.exr", "ViewLayer.sss") == 0);
}

TEST_CASE("standard output that is full or closed is an error, also of help, and closed streams do no harm") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 20, 10, 3);
  const std::vector<std::string> calls = {"--version", "filter --help", "profiles",
                                          "compare" + quoted(scene.path) + quoted(scene.path)};
  for (const std::string& call : calls) {
    for (const char* streams : {" >/dev/full 2>/dev/null", " >&- 2>/dev/null", " >&- 2>&- <&-"}) {
      INFO(call << streams);
      const std::string command = quoted(DERMIS_PROGRAM) + " " + call + streams;
      CHECK(WEXITSTATUS(std::system(command.c_str())) == 6);
    }
  }
  const std::string filter = quoted(DERMIS_PROGRAM) + " filter" + quoted(scene.path) + " -o" +
                             quoted(folder / "out.exr") +
                             " --mm-per-unit 1 --focal-px 60 --material 1=wax --material 77=wax >&- 2>&- <&-";
  CHECK(WEXITSTATUS(std::system(filter.c_str())) == 0);
  run_well({"compare", folder / "out.exr", folder / "out.exr", "--identical"});
}

TEST_CASE("nobody who listens is no reason to stop, nobody who takes the results is", "[streams]") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 20, 10, 3);
  const auto code_of = [&](const std::string& call, const std::string& streams) {
    // The reader of a pipe has ended when the program begins to write.
    const std::string command = "{ sleep 0.1; " + quoted(DERMIS_PROGRAM) + " " + call + "; echo $? >" +
                                quoted(folder / "code") + "; } " + streams;
    INFO(command);
    std::system(command.c_str());
    return std::stoi(bytes_of_file(folder / "code"));
  };
  // Notes, warnings, progress and errors.
  const std::string filter = "filter" + quoted(scene.path) + " -o" + quoted(folder / "out.exr") +
                             " --mm-per-unit 1 --focal-px 60 --material 1=wax --material 77=wax --quality draft";
  for (const char* streams : {"2>/dev/full >/dev/null", "2>&1 >/dev/null | true", "2>&- >/dev/null"}) {
    INFO(streams);
    CHECK(code_of(filter, streams) == 0);
    CHECK(code_of("info" + quoted(folder / "none.exr"), streams) == 3);
    CHECK(code_of("filter --nonsense", streams) == 2);
  }
  // More than a stream holds back, and less.
  for (const char* call : {"taps skin --rank 2 --taps 63 --json -", "profiles", "taps skin --help"}) {
    INFO(call);
    for (const char* streams : {">/dev/full", ">&-", "| true"}) {
      INFO(streams);
      CHECK(code_of(call, "2>" + quoted(folder / "errors") + " " + streams) == 6);
      const std::string errors = bytes_of_file(folder / "errors");
      CHECK(errors.starts_with("dermis: error: standard output: got "));
      CHECK(errors.find('\n') == errors.size() - 1);
    }
  }
}

namespace {

/// The program under a limit on addresses, in MiB, in a process of its own.
struct Limited {
  int exit_code;
  std::string errors;
};

Limited run_limited(const TemporaryFolder& folder, const std::string& picture, int limit_mib) {
  const std::string errors = folder / "errors";
  const std::string command = "ulimit -c 0; ulimit -v " + std::to_string(limit_mib * 1024) + "; timeout 60 '" +
                              DERMIS_PROGRAM + "' filter '" + picture + "' -o '" + (folder / "out/out.exr") +
                              "' --mm-per-unit 1 --profile skin --quality draft --quiet >/dev/null 2>'" + errors + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of_file(errors)};
}

/// Done, or refused in one line that names the limit.
void check_limited(const TemporaryFolder& folder, const std::string& picture, int limit_mib) {
  const Limited its = run_limited(folder, picture, limit_mib);
  CAPTURE(limit_mib, its.errors);
  if (its.exit_code == 0) {
    CHECK(std::filesystem::remove(folder / "out/out.exr"));
    return;
  }
  CHECK(its.exit_code == 7);
  CHECK(has(its.errors, "on addresses (ulimit -v)"));
  CHECK(its.errors.find('\n') == its.errors.size() - 1);
  CHECK(std::filesystem::is_empty(folder / "out"));
}

}  // namespace

TEST_CASE("a limit on memory is held before pixels are read", "[memory]") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 64, 48, 4);
  const auto filter = [&](const std::string& limit) {
    return run_program(filter_arguments(scene, folder / "out.exr",
                                        {"--material", "1=skin", "--quality", "draft", "--memory-limit", limit}));
  };
  check_refused(filter("1M"), 7, {scene.path, "MB of memory to take, want at most 0.0 MB, --memory-limit"});
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
  CHECK(filter("100G").exit_code == 0);
  for (const char* wrong : {"1", "G", "-1G", "1T", "nanG"})
    check_refused(filter(wrong), 2, {"--memory-limit: got " + std::string(wrong), "want megabytes or gigabytes"});
  check_refused(run_program({"info", scene.path, "--memory-limit", "1M"}), 7, {"--memory-limit"});
}

TEST_CASE("a limit on addresses that is too low for threads is told", "[memory]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 20, 12, 2);
  for (const int limit_mib : {500, 1000}) check_limited(folder, scene.path, limit_mib);
}

TEST_CASE("limits on addresses from 200 MB to 2 GB", "[.limits]") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "out");
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 20, 12, 2);
  for (int limit_mib = 200; limit_mib <= 2000; limit_mib += 25) check_limited(folder, scene.path, limit_mib);
}
