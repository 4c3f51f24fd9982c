// Names in files and of files that would steer the terminal, or look like lines of the program.
#include <filesystem>
#include <string>
#include <vector>

#include "exr/message_text.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

const std::string hostile = "\x1b[31m\x1b]0;title\x07\r\nFAKE\u202E\u2066\u2028\xc2\x9b\xff\x7f";

void check_harmless(const std::string& text) {
  CHECK(dermis::exr::escaped_lines(text) == text);
  CHECK(text.find("\nFAKE") == std::string::npos);
  CHECK_FALSE(text.starts_with("FAKE"));
}

/// Runs a command, which need not succeed, and looks at all that it prints.
Outcome check(const Words& words) {
  INFO(words.front());
  const Outcome outcome = run_program(words);
  INFO(outcome.output << outcome.errors << outcome.input);
  CHECK(outcome.exit_code >= 0);
  for (const std::string& text : {outcome.output, outcome.errors, outcome.input}) check_harmless(text);
  CHECK_FALSE((outcome.output + outcome.errors + outcome.input).empty());
  return outcome;
}

}  // namespace

TEST_CASE("no command sends names raw to the terminal", "[names]") {
  const TemporaryFolder folder;
  const MadeScene plain = make_scene(folder / "plain.exr", "touching", 24, 16, 3);
  const std::string map = folder / "map.exr";
  const std::string lights = folder / "lights.json";
  run_well({"scene", "sphere", "-o", folder / "sphere.exr", "--size", "24x16", "--shadow-map", map, "--lights", lights,
            "--shadow-texels", "16"});
  // Layers, channels, a Cryptomatte, an attribute and the path itself.
  const std::string path = folder / ("in" + hostile + ".exr");
  const std::vector<float> grey(std::size_t{24} * 16, 0.5F);
  PictureCopy(plain.path)
      .with_layer(hostile + ".")
      .without("ViewLayer")
      .with(hostile + ".Crypto" + "Object00.R", grey)
      .with(hostile + ".Crypto" + "Object00.G", grey)
      .with(hostile, grey)
      .attribute("cryptomatte/abc/name", hostile + ".CryptoObject")
      .attribute("cryptomatte/abc/manifest", "{\"\\u001b[31m\\nFAKE\\u202e\":\"3f000000\"}")
      .attribute("Frame", hostile)
      .write(path);
  const std::string output = folder / ("out" + hostile + ".exr");
  const MadeScene scene{path, plain.camera};
  const Words wax = {"--material", "1=wax"};

  CHECK(check({"info", path}).exit_code == 0);
  CHECK(check({"info", path, "--json"}).exit_code == 0);
  CHECK(check(filter_arguments(scene, output, {"--material", "1=wax", "--stats", "--quality", "draft"})).exit_code ==
        0);
  check(filter_arguments(scene, output, {"--material", "1=wax", "--stats-json", "-"}));
  check(filter_arguments(scene, output, {"--material", hostile + "=wax"}));
  check(filter_arguments(scene, output, {"--material", "1=" + hostile}));
  check(filter_arguments(scene, output, {"--material", "1=wax", "--role", "light=" + hostile}));
  check(filter_arguments(scene, output, {"--material", "1=wax", "--role", "light=none"}));
  check(filter_arguments(scene, output, {"--material", "1=wax", "--layer", hostile}));
  check(filter_arguments(scene, output, {"--material", "1=wax", "--compression", "dwaa"}));
  check(filter_arguments(scene, output, {"--material", "1=wax", "--quality", hostile}));
  check(filter_arguments(scene, folder / ("none" + hostile + "/x.exr"), wax));
  check(filter_arguments({folder / (hostile + "missing.exr"), plain.camera}, output, wax));
  check({"compare", path, plain.path});
  CHECK(check({"compare", path, output}).exit_code == 0);
  check({"compare", path, output, "--identical"});
  check({"compare", path, output, "--channels", hostile});
  check({"preview", path, "-o", folder / (hostile + ".txt")});
  check({"preview", path, "-o", folder / "x.png", "--role", "beauty=" + hostile});
  check({"light", path, "-o", output, "--lights", folder / hostile});
  check({"light", path, "-o", folder / (hostile + "/x.exr"), "--lights", lights});
  check({"texture", path, "-o", output, "--profile", hostile, "--mm-per-texel", "1"});
  check({"texture", path, "-o", folder / (hostile + "/x.exr"), "--profile", "skin", "--mm-per-texel", "1"});
  check({"warm", path, "--mm-per-unit", "1", "--material", hostile + "=wax"});
  check({"warm", path, "--mm-per-unit", "1", "--material", "1=wax", "--quality", "draft", "--cache-dir",
         folder / ("kept" + hostile)});
  check({"compare-methods", path, "-o", folder / (hostile + "/x.png"), "--mm-per-unit", "1", "--material", "1=wax"});
  check({"taps", "table:" + (folder / (hostile + ".csv"))});
  check({"profiles", "--plot", folder / (hostile + "/x.svg")});
  check({"scene", hostile, "-o", output});
  check({"scene", "sphere", "-o", folder / (hostile + "/x.exr")});
  check({"devices", hostile});
  check({hostile});
  write_bytes(lights, "{\"lights\": [{\"kind\": \"\\u001b[31m\\nFAKE\\u202e\"}]}");
  check({"light", path, "-o", output, "--lights", lights});
  write_bytes(lights, "{\"lights\": [], \"\\u001b[31m\\nFAKE\\u202e\": 1}");
  check({"light", path, "-o", output, "--lights", lights});
  write_bytes(folder / "show.toml", "\"\x1b[31m\u202E\" = \"\x1b[31m\"\n");
  check(filter_arguments(scene, output, {"--config", folder / "show.toml"}));
}
