// dermis light and filter --translucency, with a shadow map that the scene tool draws.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::exr::Picture;
using nlohmann::json;
using Words = std::vector<std::string>;

namespace {

/// A sphere, the map of its light and the light, in a folder.
struct MadeSphere {
  TemporaryFolder folder;
  std::string picture = folder / "in.exr";
  std::string lights = folder / "lights.json";

  explicit MadeSphere(const std::string& size = "90x80", const std::string& px_per_mm = "8") {
    run_well({"scene", "sphere", "-o", picture, "--size", size, "--px-per-mm", px_per_mm, "--shadow-map",
              folder / "map.exr", "--lights", lights});
  }

  std::string lit(const Words& more = {}) const {
    Words words = {"light", picture, "--lights", lights, "-o", folder / "lit.exr"};
    words.insert(words.end(), more.begin(), more.end());
    CHECK(run_well(words).empty());
    return folder / "lit.exr";
  }

  Words filter(const std::string& input, const std::string& output, const Words& more) const {
    Words words = {"filter", input,        "-o",     output,    "--mm-per-unit",
                   "1",      "--material", "1=skin", "--model", "pre-integrated"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

json read_json(const std::string& path) {
  std::ifstream file(path);
  return json::parse(file);
}

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

/// N.L of each pixel of the sphere; 2 elsewhere.
std::vector<double> facing(const Picture& picture, const json& light) {
  const std::vector<float> ids = picture.plane("ViewLayer.IndexMA.X");
  std::vector<double> result(ids.size(), 2);
  std::vector<double> sum(ids.size());
  const char* const axes[] = {"X", "Y", "Z"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<float> normal = picture.plane(std::string("ViewLayer.Normal.") + axes[axis]);
    for (std::size_t i = 0; i < ids.size(); ++i) sum[i] -= normal[i] * light["direction"][axis].get<double>();
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] == 1) result[i] = sum[i];
  return result;
}

}  // namespace

TEST_CASE("light makes what filter scatters, and the light falls on the lit side") {
  const MadeSphere sphere;
  const std::string lit = sphere.lit();
  const Picture before = Picture::read(sphere.picture);
  const Picture after = Picture::read(lit);
  const std::vector<double> n_l = facing(before, read_json(sphere.lights)["lights"][0]);
  const std::vector<float> light = after.plane("ViewLayer.DiffDir.R");
  const std::vector<float> seen = after.plane("ViewLayer.DiffCol.R");
  const std::vector<float> shine = after.plane("ViewLayer.GlossDir.R");
  const std::vector<float> beauty = after.plane("ViewLayer.Combined.R");
  int bright = 0;
  int dark = 0;
  for (std::size_t i = 0; i < n_l.size(); ++i) {
    if (n_l[i] > 1) continue;
    CHECK(beauty[i] == Approx(light[i] * seen[i] + shine[i]).margin(1e-6));
    // The highlight of the default takes 5 to 45 % of it.
    if (n_l[i] > 0.05) {
      CHECK(light[i] > 0.55 * n_l[i]);
      CHECK(light[i] < 0.99 * n_l[i]);
      ++bright;
    } else if (n_l[i] < 0) {
      CHECK(light[i] == 0);
      ++dark;
    }
  }
  CHECK(bright > 1000);
  CHECK(dark > 40);
  CHECK(*std::max_element(shine.begin(), shine.end()) > 0.02);
  // The plane behind the sphere: lit, and in its shadow.
  const std::vector<float> depth = after.plane("ViewLayer.Depth.Z");
  int shadow = 0;
  int open = 0;
  for (std::size_t i = 0; i < n_l.size(); ++i) {
    if (n_l[i] <= 1 || depth[i] > 1e9F) continue;
    (light[i] == 0 ? shadow : open) += 1;
  }
  CHECK(shadow > 50);
  CHECK(open > 500);
  // The sky keeps what it had; so does everything else that light does not make.
  CHECK(bits_of(before, "ViewLayer.Depth.Z") == bits_of(after, "ViewLayer.Depth.Z"));
  const std::string output = sphere.folder / "out.exr";
  run_well(sphere.filter(lit, output, {}));
  CHECK(relative_l2(output, lit, "ViewLayer.Combined") > 0.01);
  CHECK(relative_l2(output, lit, "ViewLayer.Combined") < 0.3);
}

TEST_CASE("what depth says is background is not lit, whatever is left of its normals") {
  const MadeSphere sphere;
  const Picture picture = Picture::read(sphere.picture);
  std::vector<float> depth = picture.plane("ViewLayer.Depth.Z");
  std::vector<float> x = picture.plane("ViewLayer.Normal.X");
  std::vector<float> combined = picture.plane("ViewLayer.Combined.R");
  const std::size_t middle = depth.size() / 2 + 45;
  REQUIRE(depth[middle] < 1e9F);
  depth[middle] = 1e10F;
  x[middle] = 0.25F;
  combined[middle] = 0.5F;
  PictureCopy(sphere.picture)
      .with("ViewLayer.Depth.Z", depth)
      .with("ViewLayer.Normal.X", x)
      .with("ViewLayer.Combined.R", combined)
      .write(sphere.picture);
  const std::vector<float> lit = Picture::read(sphere.lit()).plane("ViewLayer.Combined.R");
  CHECK(lit[middle] == 0.5F);
  CHECK(lit[middle + 1] != combined[middle + 1]);
}

TEST_CASE("translucency softens the terminator of a sphere without a dark ring") {
  const MadeSphere sphere("160x150", "12");
  const std::string lit = sphere.lit({"--shadow-softness", "1"});
  const std::string plain = sphere.folder / "plain.exr";
  const std::string through = sphere.folder / "through.exr";
  run_well(sphere.filter(lit, plain, {}));
  run_well(sphere.filter(lit, through, {"--translucency", "--lights", sphere.lights, "--thickness-softness", "1"}));
  const Picture picture = Picture::read(through);
  const std::vector<double> n_l = facing(picture, read_json(sphere.lights)["lights"][0]);
  const std::vector<float> red = picture.plane("ViewLayer.sss.R");
  const std::vector<float> plain_red = Picture::read(plain).plane("ViewLayer.sss.R");
  // From the light to the dark: the mean and the least of each band of the cosine.
  constexpr int bands = 10;
  constexpr double first = 0.5;
  constexpr double width = 0.07;
  std::vector<double> sum(bands);
  std::vector<double> least(bands, 9);
  std::vector<int> count(bands);
  double more = 0;
  for (std::size_t i = 0; i < n_l.size(); ++i) {
    const int band = static_cast<int>(std::floor((first - n_l[i]) / width));
    if (n_l[i] > 1 || band < 0 || band >= bands) continue;
    sum[band] += red[i];
    least[band] = std::min(least[band], static_cast<double>(red[i]));
    ++count[band];
    if (n_l[i] < 0) more += red[i] - plain_red[i];
  }
  for (int band = 0; band + 1 < bands; ++band) {
    CAPTURE(band, first - band * width, sum[band] / count[band], sum[band + 1] / count[band + 1], least[band]);
    REQUIRE(count[band + 1] > 20);
    // Darker and darker, and no pixel of a band is much darker than what follows a band later: a ring would be near 0.
    CHECK(sum[band + 1] / count[band + 1] < sum[band] / count[band] * 1.01);
    if (band + 2 < bands) CHECK(least[band] > sum[band + 2] / count[band + 2] * 0.9);
  }
  const auto dark = std::count_if(n_l.begin(), n_l.end(), [](double v) { return v < 0; });
  CHECK(more > 0.02 * static_cast<double>(dark));
  // The light that came through is in the beauty too.
  const std::vector<float> beauty = picture.plane("ViewLayer.Combined.R");
  const std::vector<float> plain_beauty = Picture::read(plain).plane("ViewLayer.Combined.R");
  const std::vector<float> albedo = picture.plane("ViewLayer.DiffCol.R");
  for (std::size_t i = 0; i < n_l.size(); ++i) {
    if (n_l[i] > 1) {
      CHECK(beauty[i] == plain_beauty[i]);
    } else {
      CHECK(beauty[i] - plain_beauty[i] == Approx(albedo[i] * (red[i] - plain_red[i])).margin(2e-6));
    }
  }
}

TEST_CASE("a thickness pass is used, and found by its name or by --role") {
  const MadeSphere sphere;
  json lights = read_json(sphere.lights);
  lights["lights"][0].erase("shadow_map");
  write_text(sphere.lights, lights.dump());
  const Words more = {"--translucency", "--lights", sphere.lights};
  const std::string output = sphere.folder / "out.exr";
  check_refused(run_program(sphere.filter(sphere.picture, output, more)), 5,
                {"thickness: got no image, and no light with a shadow map"});
  CHECK_FALSE(fs::exists(output));
  const std::vector<float> thickness(90 * 80, 0.2F);
  PictureCopy(sphere.picture).with("ViewLayer.Thickness.X", thickness).write(sphere.folder / "named.exr");
  PictureCopy(sphere.picture).with("mine", thickness).write(sphere.folder / "mine.exr");
  run_well(sphere.filter(sphere.folder / "named.exr", output, more));
  Words by_role = more;
  by_role.insert(by_role.end(), {"--role", "thickness=mine"});
  run_well(sphere.filter(sphere.folder / "mine.exr", sphere.folder / "out2.exr", by_role));
  CHECK(relative_l2(output, sphere.folder / "out2.exr", "ViewLayer.sss") == 0);
  run_well(sphere.filter(sphere.picture, sphere.folder / "plain.exr", {}));
  CHECK(relative_l2(output, sphere.folder / "plain.exr", "ViewLayer.sss") > 0.01);
}

TEST_CASE("what is wrong with lights is said in one line, and nothing is written") {
  const MadeSphere sphere("40x30", "4");
  const json good = read_json(sphere.lights);
  const std::string output = sphere.folder / "out.exr";
  const auto refused = [&](const Words& words, int code, const Words& parts) {
    check_refused(run_program(words), code, parts);
    CHECK_FALSE(fs::exists(output));
  };
  const Words light = {"light", sphere.picture, "--lights", sphere.lights, "-o", output};
  const auto spoilt = [&](const auto& spoil, int code, const Words& parts) {
    json lights = good;
    spoil(lights);
    write_text(sphere.lights, lights.dump());
    refused(light, code, parts);
  };
  spoilt([](json& j) { j = json::array(); }, 4, {"--lights", "got [], want an object"});
  spoilt([](json& j) { j.erase("lights"); }, 4, {"lights: got nothing, want a list"});
  spoilt([](json& j) { j["lights"][0]["kind"] = "sun"; }, 4,
         {"lights[0].kind: got \"sun\", want directional or point"});
  spoilt([](json& j) { j["lights"][0]["color"] = 1; }, 4, {"lights[0].color: got this key"});
  spoilt([](json& j) { j["lights"][0]["colour"] = {1, 2}; }, 4, {"lights[0].colour: got [1,2], want three finite"});
  spoilt([](json& j) { j["lights"][0]["direction"] = {0, 0, 0}; }, 2, {"lights[0] direction: got"});
  spoilt([](json& j) { j["lights"][0]["shadow_map"]["file"] = "none.exr"; }, 3, {"none.exr"});
  spoilt([](json& j) { j["lights"][0]["shadow_map"]["depth"] = "log"; }, 4,
         {"lights[0].shadow_map.depth: got \"log\", want linear or projective"});
  spoilt([](json& j) { j["lights"][0]["shadow_map"]["view_projection"][1] = 5; }, 4,
         {"shadow_map.view_projection: got 5, want four rows of four"});
  spoilt(
      [](json& j) {
        j["lights"][0]["shadow_map"]["view_projection"][3] = {0, 0, 1, 0};
      },
      2, {"lights[0] view_projection: got a perspective projection"});
  spoilt(
      [](json& j) {
        j["highlight"] = {{"roughness", {0.1}}, {"weight", {1, 2}}};
      },
      4, {"highlight.weight: got 2 numbers, want 1"});
  write_text(sphere.lights, "{");
  refused(light, 4, {"--lights", "want JSON"});
  fs::remove(sphere.lights);
  refused(light, 3, {"--lights", "which cannot be read"});
  write_text(sphere.lights, good.dump());
  refused(sphere.filter(sphere.picture, output, {"--translucency"}), 2, {"--lights: got nothing"});
  refused(sphere.filter(sphere.picture, output, {"--lights", sphere.lights}), 2, {"--translucency with it"});
  refused(sphere.filter(sphere.picture, output, {"--thickness-scale", "2"}), 2, {"--translucency: got"});
  refused(sphere.filter(sphere.picture, output, {"--translucency", "--thickness-shrink", "-1"}), 2,
          {"--thickness-shrink: got -1"});
  PictureCopy(sphere.picture).without("ViewLayer.Normal").write(sphere.folder / "bare.exr");
  Words bare = light;
  bare[1] = sphere.folder / "bare.exr";
  refused(bare, 5, {"normal: got no such channel"});
  // Points on one plane do not tell where they were seen from.
  const std::vector<float> zeros(40 * 30);
  PictureCopy(sphere.picture)
      .without("ViewLayer.Depth")
      .with("ViewLayer.Position.X", zeros)
      .write(sphere.folder / "bare.exr");
  refused(bare, 5, {"--eye: got nothing"});
  bare.insert(bare.end(), {"--eye", "0,0,0"});
  CHECK(run_well(bare).empty());
}

TEST_CASE("light takes the place of its input by --in-place only, and keeps a renderer's pass sss its own") {
  const MadeSphere sphere("20x20", "2");
  check_refused(run_program({"light", sphere.picture, "--lights", sphere.lights, "-o", sphere.picture}), 2,
                {"--output: got", "which is the input", "--in-place"});
  check_refused(run_program({"light", sphere.picture, "--lights", sphere.lights, "-o", sphere.folder / "x.exr",
                             "--compression", "dwaa"}),
                2, {"--compression: got dwaa", "ViewLayer.Position.Y"});
  const std::vector<float> theirs(std::size_t{20} * 20, 0.25F);
  PictureCopy(sphere.picture).with("ViewLayer.sss.R", theirs).write(sphere.picture);
  run_well({"light", sphere.picture, "--lights", sphere.lights, "-o", sphere.picture, "--in-place"});
  const std::string output = sphere.folder / "out.exr";
  CHECK(run_program(sphere.filter(sphere.picture, output, {})).exit_code == 0);
  CHECK(Picture::read(output).plane("ViewLayer.sss.R") == theirs);
  CHECK(Picture::read(output).find("ViewLayer.sss_dermis.R") != nullptr);
}
