// dermis filter on files that name their passes in other ways: other renderers, a studio, stereo, several files, names
// of materials.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
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

const Words both_materials = {"--material", "1=skin", "--material", "2=wax"};
const std::string layer = "ViewLayer.";

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

/// Two materials, and the picture in which they are scattered by their ids.
struct Shot {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 61, 33, 4);
  std::string result = folder / "result.exr";

  Shot() { run_well(filter_arguments(scene, result, both_materials)); }

  Outcome filter(const std::string& input, const std::string& output, const Words& more) const {
    return run_program(filter_arguments({folder / input, scene.camera}, folder / output, more));
  }

  /// A copy of the scene with its channels under other names: `from` is the beginning of a name.
  void rename(const std::string& file, const std::vector<std::pair<std::string, std::string>>& names) const {
    PictureCopy copy(scene.path);
    const Picture picture = Picture::read(scene.path);
    for (const auto& channel : picture.channels()) {
      for (const auto& [from, to] : names) {
        if (!channel.name.starts_with(layer + from)) continue;
        copy.with(to + channel.name.substr(layer.size() + from.size()), picture.plane(channel.name));
      }
    }
    copy.without(layer).write(folder / file);
  }

  double off(const std::string& file, const std::string& pass) const {
    const Picture a = Picture::read(folder / file);
    const Picture b = Picture::read(result);
    double squares = 0;
    double all = 0;
    for (const char* end : {".R", ".G", ".B"}) {
      const std::vector<float> x = a.plane(pass + end);
      const std::vector<float> y = b.plane(layer + "sss" + end);
      for (std::size_t i = 0; i < y.size(); ++i) {
        squares += (x[i] - y[i]) * (x[i] - y[i]);
        all += y[i] * y[i];
      }
    }
    return std::sqrt(squares / all);
  }
};

/// The ids as a Cryptomatte of materials with whole pixels.
void write_cryptomatte(const Shot& shot, const std::string& file) {
  const std::vector<float> ids = Picture::read(shot.scene.path).plane(layer + "IndexMA.X");
  std::vector<float> id(ids.size());
  std::vector<float> share(ids.size(), 1);
  for (std::size_t i = 0; i < ids.size(); ++i)
    id[i] = dermis::exr::cryptomatte_id(ids[i] == 1 ? "Hero Skin" : "wax/candle.v2");
  PictureCopy(shot.scene.path)
      .without(layer + "IndexMA")
      .with(layer + "CryptoMaterial00.r", id)
      .with(layer + "CryptoMaterial00.g", share)
      .attribute("cryptomatte/abc1234/name", layer + "CryptoMaterial")
      .attribute("cryptomatte/abc1234/manifest", R"({"Hero Skin":"00000000","wax/candle.v2":"00000000"})")
      .write(shot.folder / file);
}

/// Rounding of the light that is divided by its albedo: a product and a quotient of float, each within 2^-24.
constexpr double rounding = 1e-6;

}  // namespace

TEST_CASE("materials are told by their names in the Cryptomatte") {
  const Shot shot;
  write_cryptomatte(shot, "crypto.exr");
  const Words by_name = {"--material", "Hero Skin=skin", "--material", "wax/candle.v2=wax"};
  const Outcome outcome = shot.filter("crypto.exr", "named.exr", by_name);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(shot.off("named.exr", layer + "sss") == 0);
  CHECK(has(outcome.input, "materials " + layer + "CryptoMaterial"));
  CHECK(has(outcome.input, "--material \"Hero Skin\""));

  check_refused(shot.filter("crypto.exr", "x.exr", {"--material", "hero skin=skin"}), 5,
                {"\"hero skin\", which covers no pixel", "\"Hero Skin\""});
  check_refused(shot.filter("crypto.exr", "x.exr", {"--material", "Hero Skin=skin", "--material", "2=wax"}), 2,
                {"--material", "all by id, or all by name"});
  check_refused(shot.filter("crypto.exr", "x.exr", {"--material", "Hero Skin=skin", "--cryptomatte", "Hero Skin=1"}), 2,
                {"--cryptomatte"});
  check_refused(shot.filter("in.exr", "x.exr", {"--material", "Hero Skin=skin"}), 5, {"cryptomatte: got no such"});
  CHECK_FALSE(fs::exists(shot.folder / "x.exr"));
  const std::string info = run_well({"info", shot.folder / "crypto.exr"});
  CHECK(has(info, "Hero Skin"));
  CHECK(has(info, "wax/candle.v2"));
}

TEST_CASE("a file with lit light under another renderer's names gives the same scattered light") {
  const Shot shot;
  const Picture picture = Picture::read(shot.scene.path);
  shot.rename("raw.exr", {{"DiffCol", "diffuse_albedo"}, {"Depth.Z", "Z"}, {"Position", "P"}, {"IndexMA", "id"}});
  PictureCopy copy(shot.folder / "raw.exr");
  const std::vector<float> one(picture.plane(layer + "Depth.Z").size(), 1);
  for (const char* end : {".R", ".G", ".B"}) {
    const std::vector<float> albedo = picture.plane(layer + "DiffCol" + end);
    std::vector<float> light = picture.plane(layer + "DiffDir" + end);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] *= albedo[i];
    copy.with(std::string("diffuse_direct") + end, light);
  }
  copy.write(shot.folder / "lit.exr");
  Words words = both_materials;
  words.insert(words.end(), {"--role", "material=id"});
  const Outcome outcome = shot.filter("lit.exr", "out.exr", words);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(shot.off("out.exr", "sss") < rounding);
  // To call it raw is another picture, and a light that no table has is warned of.
  words.insert(words.end(), {"--lighting", "raw"});
  REQUIRE(shot.filter("lit.exr", "raw-out.exr", words).exit_code == 0);
  CHECK(shot.off("raw-out.exr", "sss") > 0.01);
  // Light of bounces alone is another picture, too.
  PictureCopy(shot.folder / "lit.exr")
      .without("diffuse_direct")
      .with("diffuse_indirect.R", one)
      .with("diffuse_indirect.G", one)
      .with("diffuse_indirect.B", one)
      .write(shot.folder / "bounces.exr");
  words.resize(words.size() - 2);
  const Outcome bounces = shot.filter("bounces.exr", "bounces-out.exr", words);
  CHECK(bounces.exit_code == 0);
  CHECK(has(bounces.errors, "light: no pass diffuse_direct beside diffuse_indirect.{R,G,B}"));
  CHECK(has(outcome.input, "(arnold, lit, without diffuse_indirect)"));
  check_refused(shot.filter("lit.exr", "x.exr", {"--material", "1=skin", "--preset", "blender"}), 5,
                {"light: got no such channel", "want DiffDir or DiffInd (blender), or --role"});
  check_refused(shot.filter("lit.exr", "x.exr", {"--material", "1=skin", "--preset", "nuke"}), 2,
                {"--preset: got nuke", "blender"});
}

TEST_CASE("ids that are no whole numbers do not scatter, and that is said") {
  const Shot shot;
  std::vector<float> ids = Picture::read(shot.scene.path).plane(layer + "IndexMA.X");
  ids[5] = 0.5F;
  ids[7] = 1.25F;
  PictureCopy(shot.scene.path).with(layer + "IndexMA.X", ids).write(shot.folder / "mixed.exr");
  const Outcome outcome = shot.filter("mixed.exr", "out.exr", both_materials);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.errors, "material: 2 pixels do not scatter, as their ids are no whole numbers"));
  for (float& id : ids) id /= 255;
  PictureCopy(shot.scene.path).with(layer + "IndexMA.X", ids).write(shot.folder / "fractions.exr");
  check_refused(shot.filter("fractions.exr", "x.exr", both_materials), 5,
                {"--material: got 1, 2", "the ids in the picture are ", "0.00392156"});
}

TEST_CASE("a name of a material with a blank and without quotes is said as such") {
  const Shot shot;
  check_refused(shot.filter("in.exr", "x.exr", {"--material", "Hero", "Skin=skin"}), 2, {"--material: got Hero"});
}

TEST_CASE("a map of names is a renderer of one's own") {
  const Shot shot;
  shot.rename("studio.exr", {{"DiffDir", "Key"}, {"DiffCol", "Tex"}, {"Depth", "Depth"}, {"IndexMA", "Mid"}});
  const std::string map = shot.folder / "studio.json";
  write_text(map, R"({"lighting": "raw", "roles": {"light": [["key", "sun"]], "albedo": "tex", "material": "mid"}})");
  Words words = both_materials;
  words.insert(words.end(), {"--preset", map});
  const Outcome outcome = shot.filter("studio.exr", "out.exr", words);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(has(outcome.input, "(studio, raw)"));
  CHECK(shot.off("out.exr", "sss") == 0);
  for (const auto& [text, part] :
       std::vector<std::pair<std::string, std::string>>{{R"({"lighting": "dark"})", "raw or lit"},
                                                        {R"({"roles": {"lamp": "x"}})", "the role lamp"},
                                                        {R"({"roles": {"light": [3]}})", "a list of names"},
                                                        {R"({"names": 1})", "names: 1"},
                                                        {R"({})", "no roles"},
                                                        {R"({"roles": {"light": "key"}})", "no lighting"},
                                                        {"{", "JSON"}}) {
    write_text(map, text);
    check_refused(shot.filter("studio.exr", "x.exr", words), 4, {"--preset", part});
  }
}

TEST_CASE("passes may lie in files of their own, with the number of the frame in their names") {
  const Shot shot;
  shot.rename("beauty.0012.exr", {{"DiffDir", "L.DiffDir"}, {"DiffCol", "L.DiffCol"}, {"Combined", "L.Combined"}});
  shot.rename("depth.0012.exr", {{"Depth", "Depth"}});
  shot.rename("ids.12.exr", {{"IndexMA.X", "X"}});
  Words words = both_materials;
  words.insert(words.end(), {"--role", "depth=" + (shot.folder / "depth.####.exr") + ":Depth", "--role",
                             "material=" + (shot.folder / "ids.%d.exr")});
  shot.rename("albedo.exr", {{"DiffCol.", ""}});
  words.insert(words.end(), {"--role", "albedo=" + (shot.folder / "albedo.exr")});
  const Outcome outcome = shot.filter("beauty.0012.exr", "out.exr", words);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(shot.off("out.exr", "L.sss") == 0);
  CHECK(has(outcome.input, (shot.folder / "albedo.exr") + ":{R,G,B} (--role)"));
  const Picture out = Picture::read(shot.folder / "out.exr");
  for (const auto& channel : out.channels()) CHECK_FALSE(has(channel.name, ":"));
  fs::copy_file(shot.folder / "beauty.0012.exr", shot.folder / "beauty.exr");
  check_refused(shot.filter("beauty.exr", "x.exr", words), 2, {"--role", "which has no number"});
  fs::remove(shot.folder / "ids.12.exr");
  check_refused(shot.filter("beauty.0012.exr", "x.exr", words), 3, {"ids.12.exr", "want an OpenEXR file"});
}

TEST_CASE("passes of another frame are warned of") {
  const Shot shot;
  const Picture picture = Picture::read(shot.scene.path);
  shot.rename("ids.exr", {{"IndexMA.X", "X"}});
  PictureCopy(shot.folder / "ids.exr").attribute("Frame", "13").write(shot.folder / "ids.exr");
  PictureCopy(shot.scene.path).attribute("Frame", "12").write(shot.folder / "frame.exr");
  Words words = both_materials;
  words.insert(words.end(), {"--role", "material=" + (shot.folder / "ids.exr")});
  const std::string said = "--role: " + (shot.folder / "ids.exr") + " is of another frame: its Frame is 13";
  CHECK(has(shot.filter("frame.exr", "out.exr", words).errors, said));
  const Outcome info = run_program({"info", shot.folder / "frame.exr", "--role", words.back(), "--focal-px", "99"});
  CHECK(has(info.errors, "dermis: warning: " + (shot.folder / "frame.exr") + ": " + said));
  const Outcome texture = run_program({"texture", shot.folder / "frame.exr", "--role", words.back(), "-o",
                                       shot.folder / "texture.exr", "--profile", "skin", "--mm-per-texel", "0.5"});
  CHECK(has(texture.errors, said));
  write_text(shot.folder / "lights.json",
             R"({"lights": [{"kind": "point", "position": [0, 0, -99], "colour": [1, 1, 1]}]})");
  const Outcome light =
      run_program({"light", shot.folder / "frame.exr", "--role", words.back(), "-o", shot.folder / "lit.exr",
                   "--lights", shot.folder / "lights.json", "--eye", "0,0,0"});
  CHECK(has(light.errors, said));
  CHECK_FALSE(has(shot.filter("in.exr", "out.exr", both_materials).errors, "frame"));

  // Where something stands in the ids and nothing in the depth, beyond the width of an edge.
  std::vector<float> depth = picture.plane(layer + "Depth.Z");
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (i % 61 < 9 && i / 61 < 9) depth[i] = 1e10F;
  PictureCopy(shot.scene.path).with(layer + "Depth.Z", depth).write(shot.folder / "hole.exr");
  CHECK(has(shot.filter("hole.exr", "out.exr", both_materials).errors, "material: 81 pixels have no depth, "));
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (i % 61 > 1) depth[i] = picture.plane(layer + "Depth.Z")[0];
  PictureCopy(shot.scene.path).with(layer + "Depth.Z", depth).write(shot.folder / "edge.exr");
  CHECK_FALSE(has(shot.filter("edge.exr", "out.exr", both_materials).errors, "have no depth"));
}

TEST_CASE("each view of a stereo picture is scattered") {
  const Shot shot;
  const Picture picture = Picture::read(shot.scene.path);
  PictureCopy stereo(shot.scene.path);
  for (const auto& channel : picture.channels()) {
    const std::size_t dot = channel.name.rfind('.');
    std::vector<float> right = picture.plane(channel.name);
    if (has(channel.name, "DiffDir"))
      for (float& value : right) value *= 2;
    stereo.with(channel.name.substr(0, dot) + ".left" + channel.name.substr(dot), picture.plane(channel.name));
    stereo.with(channel.name.substr(0, dot) + ".right" + channel.name.substr(dot), right);
  }
  for (const char* pass : {"DiffDir", "DiffCol", "Depth", "Position", "IndexMA", "Combined"})
    for (const char* end : {".R", ".X", ".Z"})
      if (picture.find(layer + pass + end) != nullptr) stereo.without(layer + pass + end);
  stereo.write(shot.folder / "stereo.exr");

  Words words = both_materials;
  words.insert(words.end(), {"--stats-json", shot.folder / "stats.json"});
  const Outcome outcome = shot.filter("stereo.exr", "out.exr", words);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  CHECK(shot.off("out.exr", layer + "sss.left") == 0);
  const Picture out = Picture::read(shot.folder / "out.exr");
  for (const char* end : {".R", ".G", ".B"}) {
    const std::vector<float> left = out.plane(layer + "sss.left" + end);
    const std::vector<float> right = out.plane(layer + "sss.right" + end);
    for (std::size_t i = 0; i < left.size(); ++i) REQUIRE(right[i] == 2 * left[i]);  // powers of two do not round
  }
  std::ifstream file(shot.folder / "stats.json");
  CHECK(nlohmann::json::parse(file)["views"].size() == 2);

  words = both_materials;
  words.insert(words.end(), {"--eye", "right"});
  REQUIRE(shot.filter("stereo.exr", "right.exr", words).exit_code == 0);
  const Picture one = Picture::read(shot.folder / "right.exr");
  CHECK(one.find(layer + "sss.left.R") == nullptr);
  CHECK(one.plane(layer + "sss.right.R") == out.plane(layer + "sss.right.R"));
  words.back() = "middle";
  check_refused(shot.filter("stereo.exr", "x.exr", words), 5, {"--eye: got middle", "left, right"});
  words = both_materials;
  words.insert(words.end(), {"--preview", shot.folder / "x.png"});
  check_refused(shot.filter("stereo.exr", "x.exr", words), 2, {"--preview", "--eye"});
}

TEST_CASE("the settings of a show come from a file, and from a result") {
  const Shot shot;
  const std::string toml = shot.folder / "show.toml";
  write_text(
      toml, "# a show\nmaterial = [\"1=skin\", \"2=wax\"]\nmm-per-unit = 1\nquality = \"draft\"\nallow-empty = true\n");
  const Words camera(shot.scene.camera.begin(), shot.scene.camera.begin() + 2);
  const auto call = [&](const std::string& output, const Words& more) {
    Words words = {"filter", shot.scene.path, "-o", shot.folder / output};
    words.insert(words.end(), camera.begin(), camera.end());
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  REQUIRE(call("draft.exr", {"--config", toml}).exit_code == 0);
  REQUIRE(shot.filter("in.exr", "told.exr",
                      {"--material", "1=skin", "--material", "2=wax", "--quality", "draft", "--allow-empty"})
              .exit_code == 0);
  CHECK(shot.off("draft.exr", layer + "sss") > 0);
  const auto light = [&](const char* name) { return Picture::read(shot.folder / name).plane(layer + "sss.R"); };
  CHECK(light("draft.exr") == light("told.exr"));
  // What is given stands above, and what excludes a setting takes its place.
  REQUIRE(call("final.exr", {"--config", toml, "--quality", "final"}).exit_code == 0);
  CHECK(shot.off("final.exr", layer + "sss") == 0);
  REQUIRE(call("every.exr", {"--config=" + toml, "--profile", "skin"}).exit_code == 0);
  CHECK(light("every.exr") != light("draft.exr"));
  // A result keeps its settings, but not what it was made from.
  const auto config = Picture::read(shot.folder / "draft.exr").text_attribute("dermis:config");
  REQUIRE(config);
  CHECK(has(*config, "quality=\"draft\""));
  CHECK_FALSE(has(*config, "draft.exr"));
  REQUIRE(
      run_program({"filter", shot.scene.path, "-o", shot.folder / "again.exr", "--config", shot.folder / "draft.exr"})
          .exit_code == 0);
  CHECK(light("again.exr") == light("draft.exr"));

  write_text(toml, "qualty = \"draft\"\n");
  check_refused(call("x.exr", {"--config", toml}), 2, {"--config " + toml, "qualty", "\"quality\""});
  write_text(toml, "output = \"y.exr\"\n");
  check_refused(call("x.exr", {"--config", toml}), 2, {"the setting output"});
  write_text(toml, "[shot]\nquality = \"draft\"\n");
  check_refused(call("x.exr", {"--config", toml}), 2, {"[shot]"});
  check_refused(call("x.exr", {"--config", shot.folder / "none.toml"}), 3, {"none.toml"});
  check_refused(call("x.exr", {"--config", shot.scene.path}), 4, {"dermis:config"});
  CHECK_FALSE(fs::exists(shot.folder / "x.exr"));
}

TEST_CASE("what was taken is said: roles with their rules, camera, kernels in pixels, what was left out") {
  const Shot shot;
  std::vector<float> ids = Picture::read(shot.scene.path).plane(layer + "IndexMA.X");
  ids[5] = 1.5F;
  std::vector<float> light = Picture::read(shot.scene.path).plane(layer + "DiffDir.R");
  light[9] = std::numeric_limits<float>::quiet_NaN();
  PictureCopy(shot.scene.path)
      .with(layer + "IndexMA.X", ids)
      .with(layer + "DiffDir.R", light)
      .write(shot.folder / "odd.exr");
  const Outcome outcome = shot.filter("odd.exr", "out.exr", both_materials);
  REQUIRE(outcome.exit_code == 0);
  for (const char* part : {"light ViewLayer.DiffDir.{R,G,B} (blender, raw, without DiffInd)",
                           "albedo ViewLayer.DiffCol", "camera: perspective", "from --focal-px", "--material 1 skin: ",
                           "px in the median", "left out: 1 pixels with light that is not finite"})
    CHECK(has(outcome.input, part));
  CHECK(shot.filter("odd.exr", "out.exr", {"--profile", "skin", "--quiet"}).input.empty());

  Words words = {"--material", "1=burley:0.001/0.001/0.001"};
  const Outcome narrow = shot.filter("in.exr", "narrow.exr", words);
  CHECK(has(narrow.errors, "it changes nothing that can be seen"));
  words.insert(words.end(), {"--role", "light=ViewLayer.DiffDir"});
  CHECK(has(shot.filter("in.exr", "told.exr", words).errors, "--lighting: nothing says whether"));
  words.emplace_back("--strict");
  check_refused(shot.filter("in.exr", "x.exr", words), 2, {"--mm-per-unit", "no warning, with --strict"});
  CHECK_FALSE(fs::exists(shot.folder / "x.exr"));
}
