// dermis filter of several pictures, one after the other.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
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
  CHECK(stats_in(folder / "out/a.json")["tiles"]["reused"] == 0);
  CHECK(stats_in(folder / "out/b.json")["tiles"]["reused"].get<int>() > 0);
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
  refuses(folder / "out/a.exr", {folder / "b.exr"}, {"--output: got", "a folder that exists, for 2 pictures"});
  refuses(folder / "out", {}, {"--output: got", "for one picture"});
  refuses(folder / "out/a.exr", {"--reuse"}, {"--reuse: got one picture"});
  refuses(folder / "out", {folder / "b.exr", "--tile-map", folder / "t.png"},
          {"--tile-map: got", "a folder that exists"});
  refuses(folder / "out", {folder / "other/a.exr"}, {"--output: got", "inputs of different names"});
}
