// The beauty after scattering: it takes in no noise of passes, and no value that was not there.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::exr::Picture;
using Words = std::vector<std::string>;

namespace {

const std::string combined = "ViewLayer.Combined";
constexpr std::array ends = {".R", ".G", ".B"};

/// A scene whose beauty is diffuse light times colour and glossy light times colour, to the last bit but one.
struct GlossyScene {
  TemporaryFolder folder;
  Random random;
  MadeScene scene;
  std::size_t pixels;
  std::vector<std::vector<float>> light;  // of each colour
  std::vector<std::vector<float>> beauty;

  explicit GlossyScene(std::uint32_t salt)
      : random(salt),
        scene(make_scene(folder / "scene.exr", "touching", random.integer(60, 90), random.integer(50, 70), 2)),
        pixels(Picture::read(scene.path).plane(combined + ".R").size()) {
    const Picture picture = Picture::read(scene.path);
    PictureCopy copy(scene.path);
    for (const char* end : ends) {
      light.push_back(picture.plane(std::string("ViewLayer.DiffDir") + end));
      const std::vector<float> albedo = picture.plane(std::string("ViewLayer.DiffCol") + end);
      const float gloss = static_cast<float>(random.uniform(0.1, 0.3));
      const float colour = static_cast<float>(random.uniform(0.3, 0.9));
      std::vector<float> sum(pixels);
      for (std::size_t i = 0; i < pixels; ++i) sum[i] = albedo[i] * light.back()[i] + gloss * colour;
      copy.with(std::string("ViewLayer.GlossInd") + end, std::vector<float>(pixels, gloss));
      copy.with(std::string("ViewLayer.GlossCol") + end, std::vector<float>(pixels, colour));
      copy.with(combined + end, sum);
      beauty.push_back(std::move(sum));
    }
    copy.write(scene.path);
  }

  /// The scene with a pass in which each value is `change`d, of its number.
  template <class Change>
  std::string changed(const std::string& name, const std::string& pass, const Change& change) const {
    PictureCopy copy(scene.path);
    const Picture picture = Picture::read(scene.path);
    for (const char* end : ends) {
      std::vector<float> values = picture.plane(pass + end);
      for (std::size_t i = 0; i < pixels; ++i) values[i] = change(i, values[i]);
      copy.with(pass + end, values);
    }
    copy.write(folder / name);
    return folder / name;
  }

  Outcome filter(const std::string& input, const std::string& output, const Words& more = {}) const {
    Words arguments = {"--material", "1=burley:3/2/1", "--material", "2=wax"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(filter_arguments({input, scene.camera}, folder / output, arguments));
  }

  double off(const std::string& a, const std::string& b) const { return relative_l2(folder / a, folder / b, combined); }
};

/// Factors about 1 whose mean over two neighbours is 1.
std::vector<float> noise(Random& random, std::size_t pixels) {
  std::vector<float> factors(pixels, 1);
  for (std::size_t i = 0; i + 1 < pixels; i += 2) {
    const float off = static_cast<float>(random.uniform(0.3, 0.9)) * (random.coin() ? 1.0F : -1.0F);
    factors[i] = 1 + off;
    factors[i + 1] = 1 - off;
  }
  return factors;
}

std::vector<float> beauty_of(const std::string& path) {
  const Picture picture = Picture::read(path);
  std::vector<float> all;
  for (const char* end : ends) {
    const std::vector<float> plane = picture.plane(combined + end);
    all.insert(all.end(), plane.begin(), plane.end());
  }
  return all;
}

/// Roundings of a handful of float32 operations on values about 1, in both pictures.
constexpr double rounding = 1e-6;

}  // namespace

TEST_CASE("light that is lit and taken for raw, or the other way round, is told by the beauty") {
  const GlossyScene made(65);
  const Picture picture = Picture::read(made.scene.path);
  PictureCopy copy(made.scene.path);
  for (const char* end : ends) {
    std::vector<float> light = picture.plane(std::string("ViewLayer.DiffDir") + end);
    const std::vector<float> albedo = picture.plane(std::string("ViewLayer.DiffCol") + end);
    for (std::size_t i = 0; i < made.pixels; ++i) light[i] *= albedo[i];
    copy.with(std::string("ViewLayer.DiffDir") + end, light);
  }
  const std::string lit = made.folder / "lit.exr";
  copy.write(lit);
  CHECK(made.filter(lit, "lit_sss.exr", {"--lighting", "lit"}).errors.empty());
  CHECK(has(made.filter(lit, "wrong.exr").errors, "--lighting: with raw the passes are "));
  CHECK(has(made.filter(made.scene.path, "wrong.exr", {"--lighting", "lit"}).errors,
            "--lighting: with lit the passes are "));
}

TEST_CASE("the other passes of a view are those of that view") {
  const GlossyScene made(66);
  const Picture picture = Picture::read(made.scene.path);
  PictureCopy copy(made.scene.path);
  for (const auto& channel : picture.channels()) {
    const std::size_t dot = channel.name.rfind('.');
    for (const std::string eye : {".left", ".right"})
      copy.with(channel.name.substr(0, dot) + eye + channel.name.substr(dot), picture.plane(channel.name));
  }
  for (const auto& channel : picture.channels()) copy.without(channel.name);
  const std::string stereo = made.folder / "stereo.exr";
  copy.write(stereo);
  CHECK(made.filter(made.scene.path, "mono_sss.exr", {"--compose", "sum"}).errors.empty());
  CHECK(made.filter(stereo, "stereo_sss.exr", {"--compose", "sum"}).errors.empty());
  const Picture mono = Picture::read(made.folder / "mono_sss.exr");
  const Picture both = Picture::read(made.folder / "stereo_sss.exr");
  for (const char* end : ends)
    for (const std::string eye : {".left", ".right"})
      CHECK(both.plane(combined + eye + end) == mono.plane(combined + end));
}

TEST_CASE("passes that add up to the beauty: all ways to compose it agree, and none says anything") {
  const GlossyScene made(60);
  for (const std::string compose : {"auto", "difference", "sum", "beauty"}) {
    const Outcome outcome = made.filter(made.scene.path, compose + ".exr", {"--compose", compose});
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors.empty());
    CHECK(made.off(compose + ".exr", "auto.exr") < rounding);
  }
  CHECK(relative_l2(made.folder / "auto.exr", made.scene.path, combined) > 1e-3);
  CHECK(is_identical(made.folder / "auto.exr", made.folder / "difference.exr"));
}

TEST_CASE("the passes of another renderer add up to the beauty by its own names") {
  GlossyScene made(67);
  const Picture picture = Picture::read(made.scene.path);
  PictureCopy copy(made.scene.path);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> albedo = picture.plane(std::string("ViewLayer.DiffCol") + ends[c]);
    std::vector<float> lit(made.pixels);
    std::vector<float> half(made.pixels);
    for (std::size_t i = 0; i < made.pixels; ++i) {
      lit[i] = albedo[i] * made.light[c][i];
      half[i] = (made.beauty[c][i] - lit[i]) / 2;
    }
    copy.with(std::string("diffuse_direct") + ends[c], lit).with(std::string("diffuse_albedo") + ends[c], albedo);
    copy.with(std::string("specular_direct") + ends[c], half).with(std::string("coat_direct") + ends[c], half);
    copy.with(std::string(1, ends[c][1]), made.beauty[c]);
  }
  for (const char* pass : {"Combined", "DiffDir", "DiffCol", "Gloss"}) copy.without(std::string("ViewLayer.") + pass);
  for (const auto& channel : picture.channels())
    if (const std::string pass = channel.name.substr(10); pass == "Depth.Z" || pass == "IndexMA.X")
      copy.with(pass, picture.plane(channel.name)).without(channel.name);
  const std::string arnold = made.folder / "arnold.exr";
  copy.write(arnold);
  const auto red = [&](const std::string& name) { return Picture::read(made.folder / name).plane("R"); };
  const Words by_ids = {"--role", "material=IndexMA.X", "--compose"};
  for (const std::string compose : {"difference", "sum", "beauty"}) {
    Words words = by_ids;
    words.push_back(compose);
    const Outcome outcome = made.filter(arnold, compose + ".exr", words);
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors.empty());
  }
  const std::vector<float> sum_red = red("sum.exr");
  const std::vector<float> difference_red = red("difference.exr");
  for (std::size_t i = 0; i < made.pixels; ++i) REQUIRE(sum_red[i] == Approx(difference_red[i]).margin(1e-5));
  REQUIRE(sum_red != made.beauty[0]);

  // Of what is not there, what could be is listed, and the beauty has a name of its own.
  Words by_sum = by_ids;
  by_sum.emplace_back("sum");
  copy.without("coat_direct").write(arnold);
  const std::string lost = made.filter(arnold, "lost.exr", by_sum).errors;
  INFO(lost);
  CHECK(has(lost, arnold + ": R,G,B: the passes are "));
  CHECK(has(lost, "is lost or scattered, there being no coat_direct, "));
  copy.without("specular_direct").write(arnold);
  check_refused(made.filter(arnold, "x.exr", by_sum), 5,
                {"--compose: got sum, and no pass of what R,G,B has beside the diffuse light: coat_direct, "});
}

TEST_CASE("noise in passes that is not in the beauty stays out of it") {
  GlossyScene made(61);
  const std::vector<float> factors = noise(made.random, made.pixels);
  const std::string noisy =
      made.changed("noisy.exr", "ViewLayer.DiffDir", [&](std::size_t i, float value) { return value * factors[i]; });
  made.filter(made.scene.path, "clean.exr");
  const Outcome outcome = made.filter(noisy, "auto.exr");
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.errors, "dermis: warning: " + noisy + ": ViewLayer.Combined: the passes are "));
  CHECK(has(outcome.errors, "--compose beauty"));
  CHECK(made.off("auto.exr", "clean.exr") < rounding);
  CHECK(relative_l2(made.folder / "auto.exr", made.folder / "clean.exr", "ViewLayer.sss") < rounding);
  const Outcome difference = made.filter(noisy, "difference.exr", {"--compose", "difference"});
  CHECK(has(difference.errors, "not of one render"));
  CHECK(made.off("difference.exr", "clean.exr") > 0.02);
  // The kernel is narrow, so that it is not what is warned of first.
  const Outcome strict = run_program(filter_arguments({noisy, made.scene.camera}, made.folder / "strict.exr",
                                                      {"--material", "1=burley:1/1/0.5", "--strict"}));
  CHECK(strict.exit_code == 4);
  CHECK_FALSE(std::filesystem::exists(made.folder / "strict.exr"));
}

TEST_CASE("noise in a beauty whose passes have none does not stay where light scatters") {
  GlossyScene made(62);
  const std::vector<float> factors = noise(made.random, made.pixels);
  const std::string noisy =
      made.changed("noisy.exr", combined, [&](std::size_t i, float value) { return value * factors[i]; });
  made.filter(made.scene.path, "sum.exr", {"--compose", "sum"});
  const Outcome outcome = made.filter(noisy, "auto.exr");
  INFO(outcome.errors);
  CHECK(has(outcome.errors, "--compose sum"));
  const std::vector<float> clean = beauty_of(made.folder / "sum.exr");
  const std::vector<float> before = beauty_of(noisy);
  const std::vector<float> after = beauty_of(made.folder / "auto.exr");
  std::size_t others = 0;
  for (std::size_t i = 0; i < after.size(); ++i) others += after[i] == before[i] || after[i] == clean[i] ? 0 : 1;
  CHECK(others == 0);
  CHECK(after != before);
}

TEST_CASE("a firefly in the light alone is limited to the beauty, and never takes it below 0") {
  GlossyScene made(63);
  const std::size_t at = static_cast<std::size_t>(made.random.integer(0, static_cast<int>(made.pixels) - 1));
  const std::string spoiled = made.changed("spoiled.exr", "ViewLayer.DiffDir",
                                           [&](std::size_t i, float value) { return i == at ? 1e4F : value; });
  made.filter(made.scene.path, "clean.exr");
  const Outcome outcome = made.filter(spoiled, "auto.exr");
  INFO(outcome.errors);
  CHECK(has(outcome.errors, "brighter than it in 1 of "));
  CHECK(made.off("auto.exr", "clean.exr") < rounding);
  const Outcome difference = made.filter(spoiled, "difference.exr", {"--compose", "difference"});
  CHECK(has(difference.errors, "warning"));
  for (const float value : beauty_of(made.folder / "difference.exr")) REQUIRE(value >= 0);
  CHECK(made.off("difference.exr", "clean.exr") > 1);
}

TEST_CASE("light that is not of the beauty is scattered as it is, with a warning, and never takes it below 0") {
  GlossyScene made(65);
  const std::string other =
      made.changed("other.exr", "ViewLayer.DiffDir", [](std::size_t i, float value) { return i % 7 == 0 ? 9 : value; });
  const Outcome outcome = made.filter(other, "auto.exr");
  CHECK(has(outcome.errors, "not of one render"));
  made.filter(other, "difference.exr", {"--compose", "difference"});
  CHECK(is_identical(made.folder / "auto.exr", made.folder / "difference.exr"));
  for (const float value : beauty_of(made.folder / "auto.exr")) REQUIRE(value >= 0);
}

TEST_CASE("what is in the beauty and in no pass is kept") {
  GlossyScene made(64);
  const std::string glowing =
      made.changed("glowing.exr", combined, [&](std::size_t i, float value) { return i % 3 == 0 ? value + 2 : value; });
  const Outcome outcome = made.filter(glowing, "auto.exr");
  CHECK(outcome.errors.empty());
  made.filter(made.scene.path, "clean.exr");
  const std::vector<float> clean = beauty_of(made.folder / "clean.exr");
  const std::vector<float> after = beauty_of(made.folder / "auto.exr");
  for (std::size_t i = 0; i < after.size(); ++i)
    REQUIRE(after[i] == Approx(clean[i] + (i % made.pixels % 3 == 0 ? 2 : 0)).margin(1e-5));
  CHECK(has(made.filter(glowing, "sum.exr", {"--compose", "sum"}).errors, "want --compose difference"));
}

namespace {

/// Half a beauty of halves: much light on a dark colour, beside little on a white one, onto which it scatters.
std::string write_half_beauty(const TemporaryFolder& folder, const MadeScene& scene) {
  const Picture from = Picture::read(scene.path);
  Picture to(from.data_window(), from.display_window());
  for (const auto& channel : from.channels()) {
    const dermis::Format format = channel.name.starts_with(combined) ? dermis::Format::f16 : channel.format;
    to.add_channels(std::span(&channel.name, 1), format);
  }
  const std::size_t width = static_cast<std::size_t>(from.width());
  for (const auto& channel : from.channels()) {
    std::vector<float> values = from.plane(channel.name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool is_bright = i % width < width / 2;
      if (channel.name.starts_with("ViewLayer.DiffDir")) values[i] = is_bright ? 1.6e5F : 1e3F;
      if (channel.name.starts_with("ViewLayer.DiffCol")) values[i] = is_bright ? 0.4F : 1.0F;
      if (channel.name.starts_with(combined)) values[i] = is_bright ? 6.4e4F : 1e3F;
    }
    to.store(std::span(&channel.name, 1), values);
  }
  to.write(folder / "half.exr");
  return folder / "half.exr";
}

}  // namespace

TEST_CASE("a beauty of halves that cannot hold the result becomes float, or is clamped if it may not") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 60, 20, 4);
  const MadeScene half{write_half_beauty(folder, scene), scene.camera};
  const Outcome outcome = run_program(filter_arguments(half, folder / "float.exr", {"--profile", "burley:3/3/3"}));
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.errors, "dermis: note: ViewLayer.Combined: "));
  CHECK(has(outcome.errors, "--keep-formats"));
  CHECK(Picture::read(folder / "float.exr").find(combined + ".G")->format == dermis::Format::f32);
  const std::vector<float> beauty = beauty_of(folder / "float.exr");
  CHECK(*std::max_element(beauty.begin(), beauty.end()) > 66000);
  for (const float value : beauty) REQUIRE(std::isfinite(value));

  const Outcome kept =
      run_program(filter_arguments(half, folder / "kept.exr", {"--profile", "burley:3/3/3", "--keep-formats"}));
  CHECK(has(kept.errors, "are 65504"));
  CHECK(Picture::read(folder / "kept.exr").find(combined + ".G")->format == dermis::Format::f16);
  const std::vector<float> clamped = beauty_of(folder / "kept.exr");
  for (std::size_t i = 0; i < beauty.size(); ++i)
    REQUIRE(clamped[i] == Approx(std::min(beauty[i], 65504.0F)).epsilon(0x1p-11));  // half the distance of two halves
}
