// dermis filter of several pictures, one after the other.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::exr::Picture;
using Words = std::vector<std::string>;

namespace {

nlohmann::json stats_in(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

}  // namespace

TEST_CASE("pictures of a sequence come out as each by itself, and reuse what has not changed") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "a.exr", "sphere", 130, 90, 3);
  fs::copy_file(folder / "a.exr", folder / "b.exr");
  fs::create_directory(folder / "out");
  fs::create_directory(folder / "alone");
  const Words profile = {"--profile", "skin"};
  Words arguments = filter_arguments(scene, folder / "out", profile);
  arguments.insert(arguments.end(), {folder / "b.exr", "--reuse", "--stats-json", folder / "out"});
  run_well(arguments);
  run_well(filter_arguments(scene, folder / "alone/a.exr", profile));
  CHECK(relative_l2(folder / "out/a.exr", folder / "alone/a.exr", "ViewLayer.sss") == 0);
  CHECK(relative_l2(folder / "out/b.exr", folder / "alone/a.exr", "ViewLayer.sss") == 0);
  CHECK(stats_in(folder / "out/a.json")["blocks"]["reused"] == 0);
  CHECK(stats_in(folder / "out/b.json")["blocks"]["reused"].get<int>() > 0);
}

TEST_CASE("the outputs of a sequence are folders") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "a.exr", "sphere", 20, 10, 3);
  fs::copy_file(folder / "a.exr", folder / "b.exr");
  fs::create_directory(folder / "out");
  fs::create_directory(folder / "other");
  fs::copy_file(folder / "a.exr", folder / "other/a.exr");
  const auto refuses = [&](const std::string& output, const Words& more, const Words& parts) {
    Words arguments = filter_arguments(scene, output, {"--profile", "skin"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_refused(run_program(arguments), 2, parts);
    CHECK(fs::is_empty(folder / "out"));
  };
  refuses(folder / "out/a.exr", {folder / "b.exr"},
          {"--output: got", "a folder that exists, or #### in its name, for 2 pictures"});
  refuses(folder / "out/a.exr", {"--reuse"}, {"--reuse: got one picture"});
  refuses(folder / "out", {folder / "b.exr", "--tile-map", folder / "t.png"},
          {"--tile-map: got", "a folder that exists"});
  refuses(folder / "out", {folder / "other/a.exr"}, {"--output: got", "inputs of different names"});
}

namespace {

/// Frames: one as it should be, one of background only, one of another material, one cut in half, one that no camera
/// fits, and the first one again.
struct Sequence {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "1.exr", "sphere", 60, 40, 3);

  Sequence() {
    const std::size_t pixels = std::size_t{60} * 40;
    PictureCopy empty(scene.path);
    empty.with("ViewLayer.Depth.Z", std::vector<float>(pixels, 1e10F));
    for (const char* axis : {"X", "Y", "Z"})
      empty.with(std::string("ViewLayer.Position.") + axis, std::vector<float>(pixels, 0));
    empty.write(folder / "2.exr");
    PictureCopy(scene.path).with("ViewLayer.IndexMA.X", std::vector<float>(pixels, 9)).write(folder / "3.exr");
    const std::string bytes = bytes_of_file(scene.path);
    write_bytes(folder / "4.exr", bytes.substr(0, bytes.size() / 2));
    PictureCopy(scene.path).without("ViewLayer.Position").write(folder / "5.exr");
    fs::copy_file(scene.path, folder / "6.exr");
    fs::create_directory(folder / "out");
  }

  Outcome filter(const std::string& frames, const Words& more = {}) const {
    Words arguments = {"filter", "-o", folder / "out", "--mm-per-unit", "1", "--material", "1=skin"};
    for (const char frame : frames) arguments.push_back(folder / (std::string(1, frame) + ".exr"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

}  // namespace

TEST_CASE("frames that fail are named, and the others are done") {
  const Sequence shot;
  const Outcome outcome = shot.filter("123456");
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 8);
  CHECK(has(outcome.errors, "dermis: error: " + (shot.folder / "4.exr")));
  CHECK(has(outcome.errors, "dermis: error: " + (shot.folder / "5.exr") + ": camera"));
  CHECK(has(outcome.errors, "dermis: error: 2 of 6 pictures failed\n"));
  CHECK(is_identical(shot.folder / "out/1.exr", shot.folder / "out/6.exr"));
  CHECK_FALSE(fs::exists(shot.folder / "out/4.exr"));
  CHECK_FALSE(fs::exists(shot.folder / "out/5.exr"));
  CHECK(shot.filter("54", {"--quiet"}).exit_code == 5);  // all failed: the first one's

  fs::remove(shot.folder / "out/1.exr");
  const Outcome stopped = shot.filter("541", {"--quiet", "--no-keep-going"});
  CHECK(stopped.exit_code == 5);
  CHECK(has(stopped.errors, "dermis: error: 1 of 3 pictures failed, 2 were not begun\n"));
  CHECK_FALSE(fs::exists(shot.folder / "out/1.exr"));
}

TEST_CASE("a frame in which nothing scatters is copied, without a camera") {
  const Sequence shot;
  const Outcome outcome = shot.filter("123");
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  for (const std::string frame : {"2.exr", "3.exr"}) {
    INFO(frame);
    CHECK(has(outcome.errors, "dermis: note: " + (shot.folder / frame) + ": nothing in it scatters: it is copied\n"));
    const Picture before = Picture::read(shot.folder / frame);
    const Picture after = Picture::read(shot.folder / ("out/" + frame));
    CHECK(after.channels().size() == before.channels().size() + 3);
    for (const auto& channel : before.channels()) CHECK(bits_of(before, channel.name) == bits_of(after, channel.name));
    CHECK(after.plane("ViewLayer.sss.G") == before.plane("ViewLayer.DiffDir.G"));
  }
  CHECK(shot.filter("23").exit_code == 5);
  CHECK(shot.filter("23", {"--allow-empty"}).exit_code == 0);
}

TEST_CASE("one picture in which nothing scatters is an error, unless that is allowed") {
  const Sequence shot;
  check_refused(shot.filter("3"), 5, {"--material: got 1", "the ids in the picture are 9", "--allow-empty"});
  check_refused(shot.filter("2"), 5, {"--material: got 1", "--allow-empty"});
  CHECK(fs::is_empty(shot.folder / "out"));
  CHECK(shot.filter("2", {"--allow-empty"}).exit_code == 0);
  CHECK(fs::exists(shot.folder / "out/2.exr"));
}

TEST_CASE("a folder does for one picture, as for several") {
  const Sequence shot;
  CHECK(shot.filter("1", {"--stats-json", shot.folder / "out"}).exit_code == 0);
  CHECK(fs::exists(shot.folder / "out/1.exr"));
  CHECK(fs::exists(shot.folder / "out/1.json"));
}
