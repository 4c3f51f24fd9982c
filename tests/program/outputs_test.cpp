// What becomes of the files in the place of results, and of the channels in theirs.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "commands/run.hpp"
#include "dermis/exr.hpp"
#include "exr/temporary_file.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::exr::Picture;
using dermis::exr::TemporaryFile;
using Words = std::vector<std::string>;

namespace {

struct Made {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 30, 20, 3);

  Outcome filter(const std::string& output, const Words& more = {}) const {
    Words arguments = {"--material", "1=wax"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(filter_arguments(scene, output, arguments));
  }
};

struct stat status_of(const std::string& path) {
  struct stat status = {};
  REQUIRE(stat(path.c_str(), &status) == 0);
  return status;
}

}  // namespace

TEST_CASE("a link stays a link, and the file behind it is replaced and keeps mode and owner") {
  const Made made;
  fs::create_directory(made.folder / "elsewhere");
  const std::string target = made.folder / "elsewhere/target.exr";
  write_bytes(target, "old");
  const mode_t mode = 0620;
  REQUIRE(chmod(target.c_str(), mode) == 0);
  const bool may_give_away = geteuid() == 0;
  if (may_give_away) REQUIRE(chown(target.c_str(), 1234, 1235) == 0);
  const struct stat before = status_of(target);
  fs::create_symlink("elsewhere/target.exr", made.folder / "link.exr");
  fs::create_symlink("link.exr", made.folder / "link_of_link.exr");
  CHECK(made.filter(made.folder / "link_of_link.exr").exit_code == 0);
  CHECK(fs::is_symlink(made.folder / "link_of_link.exr"));
  CHECK(fs::is_symlink(made.folder / "link.exr"));
  CHECK_FALSE(fs::is_symlink(target));
  CHECK(Picture::read(target).find("ViewLayer.sss.R") != nullptr);
  const struct stat after = status_of(target);
  CHECK(after.st_mode == before.st_mode);
  CHECK(after.st_uid == before.st_uid);
  CHECK(after.st_gid == before.st_gid);

  fs::create_symlink("elsewhere/new.exr", made.folder / "dangling.exr");
  CHECK(made.filter(made.folder / "dangling.exr").exit_code == 0);
  CHECK(fs::is_symlink(made.folder / "dangling.exr"));
  CHECK(fs::is_regular_file(made.folder / "elsewhere/new.exr"));
}

TEST_CASE("a write-protected file is not replaced, though its folder may be written") {
  const Made made;
  for (const std::string name : {"out.exr", "p.png", "s.json"}) {
    write_bytes(made.folder / name, "old");
    REQUIRE(chmod((made.folder / name).c_str(), 0444) == 0);
  }
  check_refused(made.filter(made.folder / "out.exr"), 6, {"--output: got ", "out.exr (it is write-protected)"});
  check_refused(made.filter(made.folder / "new.exr", {"--preview", made.folder / "p.png"}), 6, {"--preview: got "});
  check_refused(made.filter(made.folder / "new.exr", {"--stats-json", made.folder / "s.json"}), 6, {"--stats-json"});
  check_refused(run_program({"scene", "step", "-o", made.folder / "out.exr"}), 6, {"out.exr (it is write-protected)"});
  CHECK(bytes_of_file(made.folder / "out.exr") == "old");
  CHECK_FALSE(fs::exists(made.folder / "new.exr"));
}

TEST_CASE("the input is replaced by --in-place only, whatever it is called") {
  const Made made;
  const std::string before = bytes_of_file(made.scene.path);
  fs::create_symlink("in.exr", made.folder / "link.exr");
  fs::create_hard_link(made.scene.path, made.folder / "hard.exr");
  fs::create_directory_symlink(".", made.folder / "folder");
  for (const std::string output : {"in.exr", "link.exr", "hard.exr", "folder/in.exr", "folder", "."}) {
    INFO(output);
    check_refused(made.filter(made.folder / output), 2, {"--output: got ", "which is the input", "--in-place"});
  }
  CHECK(bytes_of_file(made.scene.path) == before);
  check_refused(run_program({"filter", made.scene.path, "--mm-per-unit", "1", "--profile", "wax"}), 2,
                {"--output: got nothing", "--in-place"});
  // an output that leads to another input
  fs::create_directory(made.folder / "out");
  fs::copy_file(made.scene.path, made.folder / "other.exr");
  fs::create_symlink("../other.exr", made.folder / "out/in.exr");
  check_refused(run_program({"filter", made.scene.path, made.folder / "other.exr", "-o", made.folder / "out",
                             "--in-place", "--mm-per-unit", "1", "--profile", "wax"}),
                2, {"--output: got ", "not the input"});
  fs::remove(made.folder / "hard.exr");
  CHECK(made.filter(made.folder / "link.exr", {"--in-place"}).exit_code == 0);
  CHECK(fs::is_symlink(made.folder / "link.exr"));
  CHECK(bytes_of_file(made.scene.path) != before);
  // without a name for the output
  write_bytes(made.scene.path, before);
  Words arguments = filter_arguments(made.scene, "", {"--material", "1=wax", "--in-place"});
  arguments.erase(arguments.begin() + 2, arguments.begin() + 4);
  run_well(arguments);
  CHECK(Picture::read(made.scene.path).find("ViewLayer.sss.R") != nullptr);
}

TEST_CASE("a pass sss of the renderer's is kept, and our own is replaced with a warning") {
  const Made made;
  const std::vector<float> theirs(std::size_t{30} * 20, 0.25F);
  PictureCopy(made.scene.path).with("ViewLayer.sss.G", theirs).write(made.scene.path);
  const Outcome outcome = made.filter(made.folder / "out.exr");
  CHECK(outcome.errors == "dermis: note: ViewLayer.sss: this pass is the renderer's; ours is ViewLayer.sss_dermis\n");
  const Picture out = Picture::read(made.folder / "out.exr");
  CHECK(out.plane("ViewLayer.sss.G") == theirs);
  CHECK(out.find("ViewLayer.sss.R") == nullptr);
  CHECK(out.plane("ViewLayer.sss_dermis.G") != theirs);

  // and again: our own has the other name
  const MadeScene again{made.folder / "out.exr", made.scene.camera};
  const Outcome second = run_program(filter_arguments(again, made.folder / "second.exr", {"--material", "1=wax"}));
  CHECK(has(second.errors, "ViewLayer.sss_dermis.R: is there already, from dermis"));
  const Picture twice = Picture::read(made.folder / "second.exr");
  CHECK(twice.plane("ViewLayer.sss.G") == theirs);
  CHECK(twice.channels().size() == out.channels().size());
}

TEST_CASE("a file of dermis that does not name its pass has it under the usual name") {
  const Made made;
  const std::vector<float> old(std::size_t{30} * 20, 0.25F);
  PictureCopy copy(made.scene.path);
  for (const char* c : {"R", "G", "B"}) copy.with(std::string("ViewLayer.sss.") + c, old);
  copy.attribute("dermis:version", "0.1.0").write(made.scene.path);
  const Outcome outcome = made.filter(made.folder / "out.exr");
  CHECK(has(outcome.errors, "warning: " + made.scene.path + ": ViewLayer.sss.R: is there already"));
  CHECK(Picture::read(made.folder / "out.exr").plane("ViewLayer.sss.G") != old);
}

TEST_CASE("a compression that would change ids, positions or the like is refused, and names them") {
  const Made made;
  const std::vector<float> ids(std::size_t{30} * 20, 1.25e20F);
  PictureCopy(made.scene.path).with("ViewLayer.CryptoObject00.R", ids).write(made.scene.path);
  for (const std::string name : {"dwaa", "dwab"})
    check_refused(
        made.filter(made.folder / "out.exr", {"--compression", name}), 2,
        {"--compression: got " + name, "ViewLayer.CryptoObject00.R", "ViewLayer.Position.Y", "zip", "--output-layers"});
  check_refused(made.filter(made.folder / "out.exr", {"--compression", "pxr24"}), 2, {"ViewLayer.Depth.Z"});
  CHECK_FALSE(fs::exists(made.folder / "out.exr"));
  CHECK(made.filter(made.folder / "out.exr", {"--compression", "dwaa", "--output-layers", "changed"}).exit_code == 0);
  CHECK(Picture::read(made.folder / "out.exr").compression() == "dwaa");
  // floats of whatever name pass through B44
  CHECK(made.filter(made.folder / "b44.exr", {"--compression", "b44"}).exit_code == 0);
  CHECK(Picture::read(made.folder / "b44.exr").plane("ViewLayer.CryptoObject00.R") == ids);
}

TEST_CASE("a disk that is full names the result and the reason, and leaves what was there") {
  const TemporaryFolder folder;
  write_bytes(folder / "out.exr", "old");
  const std::string call = std::string("ulimit -f 16; '") + DERMIS_PROGRAM + "' scene head --size 200x200 -o '" +
                           (folder / "out.exr") + "' >/dev/null 2>'" + (folder / "errors") + "'";
  const int status = std::system(call.c_str());
  CHECK(WEXITSTATUS(status) == 6);
  CHECK(bytes_of_file(folder / "errors") ==
        "dermis: error: " + (folder / "out.exr") + ": got File too large, want a file that can be written\n");
  CHECK(bytes_of_file(folder / "out.exr") == "old");
  CHECK(folder.file_count() == 2);
}

TEST_CASE("pictures to look at are whole or the old ones, however full the disk is") {
  const Made made;
  const std::string in = " '" + made.scene.path + "'";
  std::vector<std::string> calls = {"preview" + in + " -o out.png", "compare" + in + in + " --heatmap out.png"};
  if (std::system("command -v gnuplot >/dev/null 2>&1") == 0)
    calls.insert(calls.end(), {"profiles --plot out.png", "profiles --plot out.svg", "taps skin --plot out.svg"});
  for (const std::string& call : calls) {
    const std::string output = made.folder / (has(call, "out.svg") ? "out.svg" : "out.png");
    bool is_written = false;
    for (int blocks = 0; !is_written; blocks = blocks == 0 ? 1 : 4 * blocks) {
      INFO(call << ", " << blocks << " KiB");
      REQUIRE(blocks < 100000);
      write_bytes(output, "old");
      const std::size_t files = made.folder.file_count();
      const std::string command = "cd '" + made.folder.path().string() + "' && (ulimit -f " + std::to_string(blocks) +
                                  "; exec '" + DERMIS_PROGRAM + "' " + call + " 2>&1 >/dev/null) | cat >errors";
      const int status = std::system(("bash -c \"set -o pipefail; " + command + "\"").c_str());
      const std::string errors = bytes_of_file(made.folder / "errors");
      INFO(errors);
      is_written = WEXITSTATUS(status) == 0;
      fs::remove(made.folder / "errors");
      CHECK(made.folder.file_count() == files);
      if (is_written) {
        CHECK(errors.empty());
        const std::string bytes = bytes_of_file(output);
        CHECK((bytes.ends_with("IEND\xAE\x42\x60\x82") || bytes.ends_with("</svg>\n\n")));
      } else {
        CHECK(WEXITSTATUS(status) == 6);
        CHECK(has(errors, "File too large"));
        CHECK(bytes_of_file(output) == "old");
      }
    }
  }
}

TEST_CASE("a gnuplot that fails leaves the old figure") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "bin");
  for (const char* script : {"#!/bin/sh\necho '<svg>'\nexit 3\n", "#!/bin/sh\n", "#!/bin/sh\nkill -9 $$\n"}) {
    write_bytes(folder / "bin/gnuplot", script);
    REQUIRE(chmod((folder / "bin/gnuplot").c_str(), 0755) == 0);
    write_bytes(folder / "out.svg", "old");
    check_refused(run_program({"profiles", "--plot", folder / "out.svg"}, {"PATH=" + (folder / "bin") + ":/bin"}), 6,
                  {"--plot", "from gnuplot"});
    CHECK(bytes_of_file(folder / "out.svg") == "old");
    CHECK(folder.file_count() == 2);
  }
}

TEST_CASE("signals that end the process leave no temporary file") {
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    INFO("signal " << number);
    const TemporaryFolder folder;
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::signal(number, SIG_DFL);
      dermis::program::handle_signals();
      const TemporaryFile one(folder / "one.exr");
      const TemporaryFile two(folder / "two.png", "--preview");
      if (folder.file_count() == 2) raise(number);
      _exit(1);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == number);
    CHECK(folder.file_count() == 0);
  }
}

TEST_CASE("what a killed run was writing goes with the next one, what another still writes stays") {
  const Made made;
  fs::create_directory(made.folder / "out");
  const std::string abandoned = made.folder / "out/.dermis-123.exr";
  const std::string foreign = made.folder / "out/.dermis-notes.exr";
  for (const std::string& file : {abandoned, foreign}) std::ofstream(file) << "half a file";
  const TemporaryFile one(made.folder / "out/one.exr");
  CHECK_FALSE(fs::exists(abandoned));
  std::ofstream(abandoned) << "half a file";
  CHECK(made.filter(made.folder / "out/result.exr").exit_code == 0);
  CHECK_FALSE(fs::exists(abandoned));
  CHECK(fs::exists(foreign));
  CHECK(fs::exists(one.path()));
  CHECK(fs::exists(made.folder / "out/result.exr"));
}
