// Text files that are no text files, or endless, or deep, or long.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

struct Reader {
  std::string option;  ///< that messages name
  std::string ending;  ///< of its files
  Words call;          ///< followed by the option and the file
};

struct Made {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "sphere", 20, 20, 3);
  std::vector<Reader> readers = {
      {"--lights", ".json", {"light", scene.path, "-o", folder / "out.exr"}},
      {"--camera", ".json", {"info", scene.path}},
      {"--preset", ".json", {"info", scene.path}},
      {"--config", ".toml", {"filter", scene.path, "-o", folder / "out.exr"}},
  };
  std::vector<std::string> profiles = {"table:", "gaussians:"};

  /// Requires that each reader refuses this file.
  void check(const std::string& path_without_ending, int code, const Words& parts, bool only_json = false) const {
    for (const Reader& reader : readers) {
      if (only_json && reader.ending != ".json") continue;
      Words words = reader.call;
      words.insert(words.end(), {reader.option, path_without_ending + reader.ending});
      check(words, code, parts, reader.option);
    }
    for (const std::string& profile : profiles)
      if (!only_json || profile != "table:")
        check({"taps", profile + path_without_ending + ".json"}, code, parts, "PROFILE");
  }

  void check(const Words& words, int code, Words parts, const std::string& argument) const {
    INFO(words.front() << " " << words.back().substr(0, 200));
    parts.push_back(argument);
    const Outcome outcome = run_program(words);
    check_refused(outcome, code, parts);
    CHECK(outcome.errors.size() < 1500);  // with a list of profiles
    CHECK_FALSE(fs::exists(folder / "out.exr"));
  }

  void write(const std::string& text) const {
    for (const char* name : {"x.json", "x.toml"}) write_bytes(folder / name, text);
  }
};

std::string repeated(const std::string& text, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

}  // namespace

TEST_CASE("text is read from ordinary files alone", "[text files]") {
  const Made made;
  for (const char* ending : {".json", ".toml"}) {
    REQUIRE(mkfifo((made.folder / ("pipe" + std::string(ending))).c_str(), 0600) == 0);
    fs::create_symlink("/dev/zero", made.folder / ("zeros" + std::string(ending)));
    fs::create_directory(made.folder / ("folder" + std::string(ending)));
  }
  for (const char* name : {"pipe", "zeros", "folder", "missing"})
    made.check(made.folder / name, 3, {"which cannot be read"});
}

TEST_CASE("text files are of at most 16 MB, and hold no byte 0", "[text files]") {
  const Made made;
  made.write(std::string("{\"a\": \"\0\"}", 10));
  made.check(made.folder / "x", 4, {"a byte 0 at 7, want a text file"});
  for (const char* name : {"x.json", "x.toml"}) fs::resize_file(made.folder / name, (16 << 20) + 1);
  made.check(made.folder / "x", 4, {"more than 16 MB"});
}

TEST_CASE("JSON of too many levels is refused, wherever it begins", "[text files]") {
  const Made made;
  constexpr int levels = 200000;
  for (const std::string& text :
       {repeated("[", levels), repeated("{\"a\":", levels), repeated("[", levels) + repeated("]", levels),
        "{\"lights\": " + repeated("[", levels) + repeated("]", levels) + "}",
        "{\"terms\": [{\"weight\": " + repeated("[", levels) + repeated("]", levels) + "}]}",
        "{\"roles\": {\"light\": " + repeated("[", levels) + repeated("]", levels) + "}}"}) {
    made.write(text);
    made.check(made.folder / "x", 4, {"more than 32 levels"}, true);
  }
}

TEST_CASE("what a file says is not said back at length", "[text files]") {
  const Made made;
  const std::string long_text(1 << 20, 'x');
  for (const std::string& text : {"{\"" + long_text + "\": 1}", "\"" + long_text + "\"", "[\"" + long_text + "\"]",
                                  "{\"lights\": \"" + long_text + "\"}", long_text, "\"" + long_text}) {
    made.write(text);
    made.check(made.folder / "x", 4, {"want"}, true);
  }
  write_bytes(made.folder / "x.csv", "0, 1, 1, " + long_text + "\n1, 1, 1, 1\n");
  made.check({"taps", "table:" + (made.folder / "x.csv")}, 4, {"line 1", "B = xxx"}, "PROFILE");
  made.check({"taps", long_text.substr(0, 60000)}, 2, {"xxx..."}, "PROFILE");
}

TEST_CASE("tables and sums of Gaussians have at most so many rows and terms", "[text files]") {
  const Made made;
  const auto table_of = [](int rows) {
    std::string text;
    for (int i = 0; i < rows; ++i) text += std::to_string(0.001 * i) + ", 1, 1, 1\n";
    return text;
  };
  write_bytes(made.folder / "x.csv", table_of(4097));
  made.check({"taps", "table:" + (made.folder / "x.csv")}, 4, {"line 4097", "at most 4096 rows"}, "PROFILE");
  write_bytes(made.folder / "x.csv", table_of(4096));
  run_well({"taps", "table:" + (made.folder / "x.csv"), "--taps", "7", "--model", "pre-integrated"});
  const std::string term = R"({"variance_mm2": 1, "weight": [1, 1, 1]})";
  write_bytes(made.folder / "x.json", "{\"terms\": [" + repeated(term + ", ", 256) + term + "]}");
  made.check({"taps", "gaussians:" + (made.folder / "x.json")}, 4, {"got 257 terms, want at most 256"}, "PROFILE");
}

TEST_CASE("a byte 0 in the name of a map does not end it", "[text files]") {
  const Made made;
  fs::copy_file(made.scene.path, made.folder / "map.exr");
  write_bytes(made.folder / "x.json", R"({"lights": [{"kind": "point", "position": [0, 0, 0],
      "shadow_map": {"file": "map.exr\u0000.png", "channel": "ViewLayer.Depth.Z"}}]})");
  made.check({"light", made.scene.path, "-o", made.folder / "out.exr", "--lights", made.folder / "x.json"}, 4,
             {"lights[0].shadow_map.file: got map.exr\\x00.png"}, "--lights");
}
