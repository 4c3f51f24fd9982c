// Frames by patterns of names, lists and chunks.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "arguments/frames_argument.hpp"
#include "dermis/error.hpp"
#include "files/frame_names.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::program::Chunk;
using dermis::program::frame_file;
using dermis::program::frames_there;
using dermis::program::parse_frames;
using dermis::program::ranges_text;
using dermis::program::with_frame_number;
using Words = std::vector<std::string>;
using Numbers = std::vector<std::int64_t>;

TEST_CASE("a list of frames has each frame once, in the order that was asked for") {
  CHECK(parse_frames("7") == Numbers{7});
  CHECK(parse_frames("1-4") == Numbers{1, 2, 3, 4});
  CHECK(parse_frames("1001-1006x2,1200,-5--3") == Numbers{1001, 1003, 1005, 1200, -5, -4, -3});
  CHECK(parse_frames("-1-1") == Numbers{-1, 0, 1});
  CHECK(parse_frames("3,1-4,2") == Numbers{3, 1, 2, 4});
  CHECK(parse_frames("1-1000000")->size() == 1000000);
  for (const char* text :
       {"", "x", "1-", "-", "1,", ",1", "1--", "4-1", "1-4x0", "1-4x-1", "1-4x", "1x2", "1 - 4", "1.5", "0-1000000",
        "1-600000,600001-1200000", "99999999999999999999", "1-9223372036854775807"}) {
    INFO('"' << text << '"');
    CHECK_FALSE(parse_frames(text));
  }
}

TEST_CASE("every frame is in one chunk, and chunks are of one size but for one frame") {
  Random random(71);
  for (int round = 0; round < 100; ++round) {
    const auto frames = static_cast<std::size_t>(random.integer(0, 300));
    const auto chunks = static_cast<std::size_t>(random.integer(1, 50));
    INFO(frames << " frames in " << chunks << " chunks");
    std::size_t next = 0;
    std::size_t least = frames;
    std::size_t most = 0;
    for (std::size_t number = 1; number <= chunks; ++number) {
      const auto [first, end] = Chunk{number, chunks}.range(frames);
      CHECK(first == next);
      next = end;
      least = std::min(least, end - first);
      most = std::max(most, end - first);
    }
    CHECK(next == frames);
    CHECK(most - least <= 1);
  }
}

TEST_CASE("the number of a frame stands where the pattern says, as printf writes it") {
  const auto named = [](const char* pattern, std::int64_t number) {
    return with_frame_number("--output", pattern, {"in.exr", number});
  };
  CHECK(named("a/b.####.exr", 7) == "a/b.0007.exr");
  CHECK(named("a/b.%04d.exr", 7) == "a/b.0007.exr");
  CHECK(named("b.%d.exr", 1001) == "b.1001.exr");
  CHECK(named("b.##.exr", 1001) == "b.1001.exr");
  CHECK(named("b.####.exr", -5) == "b.-005.exr");
  CHECK(named("b.%04d.exr", -5) == "b.-005.exr");
  CHECK(named("b.##_c.##.exr", 3) == "b.03_c.03.exr");
  CHECK(named("folder#1/100%.exr", 3) == "folder#1/100%.exr");  // no place for a number in the name
  CHECK_THROWS_AS(with_frame_number("--output", "b.#.exr", frame_file("in.exr")), dermis::Error);

  CHECK(frame_file("a.1001.exr").number == 1001);
  CHECK(frame_file("7/a.exr").number == std::nullopt);
  CHECK(frame_file("a-0012.exr").number == 12);
  CHECK(frame_file("a.-012.exr").number == -12);
  CHECK(frame_file("-3.exr").number == -3);

  CHECK(ranges_text(Numbers{}).empty());
  CHECK(ranges_text(Numbers{-2, -1, 0, 5, 7, 8}) == "-2-0, 5, 7-8");
}

TEST_CASE("the frames that are there are those whose names the pattern makes") {
  const TemporaryFolder folder;
  for (const char* name : {"a.0001.exr", "a.0010.exr", "a.10000.exr", "a.-003.exr", "a.02.exr", "a.00003.exr",
                           "a.0004.png", "b.0005.exr", "a..exr", "a.x.exr", "a.0006_0006.exr", "a.0006_0007.exr"})
    write_bytes(folder / name, "");
  CHECK(frames_there(folder / "a.####.exr") == Numbers{-3, 1, 10, 10000});
  CHECK(frames_there(folder / "a.%04d.exr") == Numbers{-3, 1, 10, 10000});
  CHECK(frames_there(folder / "a.####_%04d.exr") == Numbers{6});
  CHECK(frames_there(folder / "c.####.exr").empty());
  CHECK(frames_there(folder / "none/a.####.exr").empty());
}

namespace {

/// Frames 8 to 11, in whose names a version follows the number, and depth in files of their own: a wrong one is seen.
struct FramesInFiles {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "scene.exr", "sphere", 24, 16, 3);

  FramesInFiles() {
    for (int frame = 8; frame <= 11; ++frame) {
      const std::string number = (frame < 10 ? "000" : "00") + std::to_string(frame);
      const std::vector<float> light(std::size_t{24} * 16, static_cast<float>(frame));
      PictureCopy(scene.path).with("ViewLayer.DiffDir.R", light).write(name(number));
      fs::copy_file(scene.path, folder / ("depth." + number + ".exr"));
    }
  }

  std::string name(const std::string& number) const { return folder / ("shot." + number + "_v03.exr"); }

  Outcome filter(const Words& more) const {
    Words words = {"filter", "--mm-per-unit", "1", "--material", "1=skin", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }

  std::size_t written() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder / "."))
      if (entry.path().filename().string().starts_with("out.")) ++count;
    return count;
  }
};

}  // namespace

TEST_CASE("patterns name the frames of inputs, outputs and roles alike") {
  const FramesInFiles shot;
  const std::string depth = "depth=" + (shot.folder / "depth.%04d.exr") + ":ViewLayer.Depth.Z";
  const Words all = {shot.name("####"), "-o", shot.folder / "out.%d.exr", "--role", depth};
  const Outcome outcome = shot.filter(all);
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK(shot.written() == 4);
  CHECK(shot.filter({shot.name("0010"), "-o", shot.folder / "alone.exr"}).exit_code == 0);
  CHECK(relative_l2(shot.folder / "out.10.exr", shot.folder / "alone.exr", "ViewLayer.sss") == 0);
  CHECK(relative_l2(shot.folder / "out.11.exr", shot.folder / "alone.exr", "ViewLayer.sss") > 0.01);

  // Chunks of a list: 9 and 11, then 8. The others stay as they are.
  for (const char* name : {"out.8.exr", "out.9.exr", "out.10.exr", "out.11.exr"}) fs::remove(shot.folder / name);
  const auto chunk = [&](const char* which) {
    return shot.filter(
        {shot.name("####"), "-o", shot.folder / "out.####.exr", "--frames", "9-11x2,8", "--chunk", which});
  };
  CHECK(chunk("2/2").exit_code == 0);
  CHECK(shot.written() == 2);
  CHECK(fs::exists(shot.folder / "out.0011.exr"));
  CHECK(fs::exists(shot.folder / "out.0008.exr"));
  CHECK(chunk("1/4").exit_code == 0);  // empty
  CHECK(shot.written() == 2);
}

TEST_CASE("frames that are not there are named in one line, and the others are done") {
  const FramesInFiles shot;
  const auto filter = [&](const Words& more) {
    Words words = {shot.name("####"), "-o", shot.folder / "out.####.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return shot.filter(words);
  };
  const std::string line = "dermis: error: " + shot.name("####") + ": got no frames 1, 5-7, 12, want their files\n";
  const Outcome stopped = filter({"--frames", "10,12,5-8,1", "--no-keep-going"});
  CHECK(stopped.exit_code == 3);
  CHECK(stopped.errors == line + "dermis: error: 5 of 7 pictures failed, 2 were not begun\n");
  CHECK(shot.written() == 0);
  const Outcome outcome = filter({"--frames", "10,12,5-8,1"});
  CHECK(outcome.exit_code == 8);
  CHECK(outcome.errors.starts_with(line));
  CHECK(outcome.errors.ends_with("dermis: error: 5 of 7 pictures failed\n"));
  CHECK(shot.written() == 2);
  const Outcome none = filter({"--frames", "100-200"});
  CHECK(none.exit_code == 3);
  CHECK(has(none.errors, "got no frames 100-200, want"));
}

TEST_CASE("patterns and lists that make no sense are refused before any work") {
  const FramesInFiles shot;
  const std::string in = shot.name("####");
  const std::string out = shot.folder / "out.####.exr";
  const auto refuses = [&](const Words& words, int code, const Words& parts) {
    check_refused(shot.filter(words), code, parts);
    CHECK(shot.written() == 0);
  };
  for (const char* list : {"10-8", "1-", "1,,2", "1-2000000"})
    refuses({in, "-o", out, "--frames", list}, 2, {"--frames", "got " + std::string(list), "1001-1100x2,1200,-5--1"});
  for (const char* chunk : {"0/4", "5/4", "1", "1/0", "1/2/3", "-1/4"})
    refuses({in, "-o", out, "--chunk", chunk}, 2, {"--chunk", "got " + std::string(chunk), "I/N"});
  refuses({shot.name("0008"), "-o", out, "--frames", "8"}, 2, {"--frames: got it with", "an input with ####"});
  refuses({shot.folder / "none.####.exr", "-o", out}, 3, {"none.####.exr: got no such file"});
  refuses({in, "-o", shot.folder / "out.exr"}, 2, {"--output: got", "or #### in its name, for 4 pictures"});
  // Tasks of a farm would take it from each other.
  refuses({in, "-o", shot.folder / "out.exr", "--chunk", "1/4"}, 2, {"--output: got", "for 4 pictures"});
  refuses({shot.scene.path, "-o", out}, 2, {"--output: got", "which has no number"});
  refuses({in, shot.folder / "depth.####.exr", "-o", out}, 2, {"--output: got", "inputs of different names"});
  refuses({in, "-o", in}, 2, {"--output: got", "which is the input", "--in-place"});
  refuses({in, "-o", out, "--preview", shot.folder / "out.png"}, 2, {"--preview: got", "for 4 pictures"});
}

TEST_CASE("a file whose very name looks like a pattern is that file") {
  const FramesInFiles shot;
  fs::copy_file(shot.scene.path, shot.folder / "take#2.exr");
  CHECK(shot.filter({shot.folder / "take#2.exr", "-o", shot.folder / "out.exr"}).exit_code == 0);
  CHECK(shot.written() == 1);
}

TEST_CASE("a frame of a pattern in which nothing scatters is copied, with a warning if the call has no other") {
  const FramesInFiles shot;
  const Words words = {
      "filter", shot.name("####"), "-o",      shot.folder / "out.####.exr", "--mm-per-unit", "1", "--material",
      "9=skin", "--quiet",         "--frames"};
  const auto filter = [&](const Words& more) {
    Words all = words;
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all);
  };
  const Outcome one = filter({"9"});
  CHECK(one.exit_code == 0);
  CHECK(has(one.errors, "--material: 1 pictures in which nothing scatters, which are copied"));
  CHECK(shot.written() == 1);
  CHECK(filter({"9", "--allow-empty"}).errors.empty());
  CHECK(filter({"8-9", "--chunk", "1/2"}).exit_code == 0);
  CHECK(filter({"8-9"}).exit_code == 5);
}
