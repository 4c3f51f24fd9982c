// dermis compare: what it prints and how it exits.
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

using dermis::exr::Picture;

namespace {

/// A scene, and a copy in which one value is off.
struct Pair {
  TemporaryFolder folder;
  int width = 0;
  int height = 0;
  int x = 0;
  int y = 0;
  std::string a;
  std::string b;

  explicit Pair(std::uint32_t salt) {
    Random random(salt);
    width = random.integer(5, 40);
    height = random.integer(5, 40);
    x = random.integer(0, width - 1);
    y = random.integer(0, height - 1);
    a = folder / "a.exr";
    b = folder / "b.exr";
    make_scene(b, "touching", width, height, 4);
    std::vector<float> green = Picture::read(b).plane("ViewLayer.DiffCol.G");
    green[static_cast<std::size_t>(y * width + x)] = 8.5F;
    PictureCopy(b).with("ViewLayer.DiffCol.G", green).write(a);
  }
};

}  // namespace

TEST_CASE("a picture is identical to itself") {
  const Pair pair(20);
  const Outcome outcome = run_program({"compare", pair.b, pair.b, "--identical", "--max-rel-l2", "0"});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors.empty());
  CHECK(has(outcome.output, "ViewLayer.DiffCol"));
  CHECK(has(outcome.output, "\nidentical\n"));
}

TEST_CASE("one value that is off is found with its pixel and both values") {
  const Pair pair(21);
  const Outcome outcome = run_program({"compare", pair.a, pair.b, "--identical", "--max-rel-l2", "1e-6"});
  INFO(outcome.output);
  CHECK(outcome.exit_code == 1);
  const std::string place =
      "at (" + std::to_string(pair.x) + ", " + std::to_string(pair.y) + ") ViewLayer.DiffCol.G: 8.5 and ";
  CHECK(has(outcome.output, place));
  CHECK(has(outcome.output, "not identical: ViewLayer.DiffCol.G, 1 values\n"));

  CHECK(run_program({"compare", pair.a, pair.b}).exit_code == 0);
  CHECK(run_program({"compare", pair.a, pair.b, "--max-rel-l2", "1e9"}).exit_code == 0);
  CHECK(run_program({"compare", pair.a, pair.b, "--identical"}).exit_code == 1);
  CHECK(run_program({"compare", pair.a, pair.b, "--identical", "--channels", "ViewLayer.Combined"}).exit_code == 0);
}

TEST_CASE("a mask restricts to pixels where a channel of the reference has a value") {
  const Pair pair(22);
  const std::vector<float> ids = Picture::read(pair.b).plane("ViewLayer.IndexMA.X");
  const float id = ids[static_cast<std::size_t>(pair.y * pair.width + pair.x)];
  const auto run = [&](float value) {
    return run_program({"compare", pair.a, pair.b, "--max-rel-l2", "0", "--mask-channel",
                        "ViewLayer.IndexMA.X=" + std::to_string(value)})
        .exit_code;
  };
  const auto run_identical = [&](float value) {
    return run_program({"compare", pair.a, pair.b, "--identical", "--mask-channel",
                        "ViewLayer.IndexMA.X=" + std::to_string(value)})
        .exit_code;
  };
  CHECK(run_identical(id) == 1);
  CHECK(run_identical(3 - id) == 0);
  CHECK(run(id) == 1);
  CHECK(run(3 - id) == 0);
  check_refused(run_program({"compare", pair.a, pair.b, "--mask-channel", "ViewLayer.IndexMA.X=9"}), 2, {"no pixel"});
  check_refused(run_program({"compare", pair.a, pair.b, "--mask-channel", "Nosuch.X=1"}), 5, {"Nosuch.X"});
  check_refused(run_program({"compare", pair.a, pair.b, "--mask-channel", "ViewLayer.IndexMA.X"}), 2,
                {"CHANNEL=VALUE"});
}

TEST_CASE("a result is compared with path-traced pictures by its scattered light") {
  const TemporaryFolder folder;
  Random random(27);
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 61, 33, 4);
  run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--material", "2=wax"}));
  const Picture result = Picture::read(folder / "out.exr");
  // As Cycles writes subsurface scattering: half the light, twice the colour; a tenth more than ours on material 2.
  const std::vector<float> ids = result.plane("ViewLayer.IndexMA.X");
  const auto write_truth = [&](const std::string& name, double noise) {
    PictureCopy copy(folder / "out.exr");
    copy.without("ViewLayer.sss");
    for (const std::string end : {".R", ".G", ".B"}) {
      std::vector<float> light = result.plane("ViewLayer.sss" + end);
      std::vector<float> colour = result.plane("ViewLayer.DiffCol" + end);
      for (std::size_t i = 0; i < light.size(); ++i) {
        light[i] *= (ids[i] == 2 ? 0.55F : 0.5F) * static_cast<float>(1 + noise * random.uniform(-1, 1));
        colour[i] *= 2;
      }
      copy.with("ViewLayer.DiffDir" + end, light).with("ViewLayer.DiffCol" + end, colour);
    }
    copy.write(folder / name);
    return folder / name;
  };
  const std::string out = folder / "out.exr";
  const std::string clean = write_truth("clean.exr", 0);
  const std::string one = run_well({"compare", out, "--truth", clean});
  INFO(one);
  CHECK(has(one, "the noise of the truth is in the error"));
  CHECK(has(one, "rel_l2 0.09091"));  // 0.1 / 1.1, on material 2
  const Outcome masked = run_program(
      {"compare", out, "--truth", clean, "--mask-channel", "ViewLayer.IndexMA.X=1", "--max-rel-l2", "1e-6"});
  CHECK(masked.exit_code == 0);
  CHECK(run_program({"compare", out, "--truth", clean, "--max-rel-l2", "1e-3"}).exit_code == 1);

  // Noise of 0.3 / sqrt(3) on 6000 values: six standard deviations are (0.17^2 / sqrt(6000)) 6 = 0.0023 of the square
  // of the light, to which the mean square may add that brighter pixels count for more.
  const std::string noisy = write_truth("noisy.exr", 0.3);
  const std::string other = write_truth("other.exr", 0.3);
  const auto within = [&](const std::vector<std::string>& truths, const std::string& limit) {
    std::vector<std::string> words = {"compare", out, "--max-rel-l2", limit};
    for (const std::string& truth : truths) words.insert(words.end(), {"--truth", truth});
    return run_program(words).exit_code == 0;
  };
  CHECK_FALSE(within({noisy}, "0.14"));
  CHECK(within({noisy, other}, "0.12"));
  CHECK(has(run_well({"compare", out, "--truth", noisy, "--truth", other}), "noise of one truth 0.1"));

  check_refused(run_program({"compare", out}), 2, {"b: got nothing to compare with", "--truth"});
  check_refused(run_program({"compare", out, clean, "--truth", clean}), 2, {"b: got it with --truth"});
  // A picture of its beauty alone is compared by that.
  PictureCopy(clean).without("ViewLayer.Diff").write(folder / "beauty.exr");
  CHECK(has(run_well({"compare", out, "--truth", folder / "beauty.exr"}), "compared: the beauty"));
}

TEST_CASE("channels that one picture lacks are named; none in common is an error") {
  const Pair pair(23);
  const std::string less = pair.folder / "less.exr";
  PictureCopy(pair.b).without("ViewLayer.Normal").write(less);
  const std::string output = run_well({"compare", less, pair.b});
  CHECK(has(output, "only in B: "));
  CHECK(has(output, "ViewLayer.Normal.X"));
  CHECK_FALSE(has(output, "only in A"));
  check_refused(run_program({"compare", less, pair.b, "--channels", "ViewLayer.Normal"}), 4,
                {"no channel that both have"});
}

TEST_CASE("pictures are compared by place, and other windows are said") {
  const Pair pair(24);
  Random random(26);
  const Picture whole = Picture::read(pair.b);
  // a crop of b that holds the place where a is off
  const int left = random.integer(0, pair.x);
  const int top = random.integer(0, pair.y);
  const dermis::exr::Window window{left, top, random.integer(pair.x + 1, pair.width) - left,
                                   random.integer(pair.y + 1, pair.height) - top};
  Picture crop(window, whole.display_window());
  for (const auto& channel : whole.channels()) {
    crop.add_channels(std::span(&channel.name, 1), channel.format);
    const std::vector<float> plane = whole.plane(channel.name);
    std::vector<float> part;
    for (int y = 0; y < window.height; ++y)
      for (int x = 0; x < window.width; ++x)
        part.push_back(plane[static_cast<std::size_t>((top + y) * pair.width + left + x)]);
    crop.store(std::span(&channel.name, 1), part);
  }
  const std::string path = pair.folder / "crop.exr";
  crop.write(path);
  const bool is_whole = window == whole.data_window();
  const Outcome same = run_program({"compare", path, pair.b, "--max-rel-l2", "0"});
  INFO(same.output << same.errors);
  CHECK(same.exit_code == 0);
  CHECK(has(same.output, "windows: A ") == !is_whole);
  CHECK(run_program({"compare", path, pair.b, "--identical"}).exit_code == (is_whole ? 0 : 1));
  for (const auto& [first, second] : {std::pair(path, pair.a), std::pair(pair.a, path)}) {
    const Outcome other = run_program({"compare", first, second, "--max-rel-l2", "1e-6"});
    CHECK(other.exit_code == 1);
    CHECK(has(other.output, "at (" + std::to_string(pair.x) + ", " + std::to_string(pair.y) + ") ViewLayer.DiffCol.G"));
  }
}

TEST_CASE("pictures that have no pixel in common cannot be compared") {
  const Pair pair(27);
  Picture beside({pair.width, 0, 3, 3}, {0, 0, pair.width, pair.height});
  const std::string name = "ViewLayer.DiffCol.G";
  beside.add_channels(std::span(&name, 1), dermis::Format::f32);
  beside.write(pair.folder / "beside.exr");
  check_refused(run_program({"compare", pair.folder / "beside.exr", pair.b}), 4,
                {"A: got 3 x 3 pixels at (", "overlaps"});
}

TEST_CASE("the heat map is brightest where the difference is") {
  const Pair pair(25);
  const std::string path = pair.folder / "heat.png";
  const std::string output = run_well({"compare", pair.a, pair.b, "--heatmap", path});
  CHECK(has(output, "heat map: brightest = "));
  const auto png = OIIO::ImageInput::open(path);
  REQUIRE(png);
  REQUIRE(png->spec().width == pair.width);
  REQUIRE(png->spec().height == pair.height);
  std::vector<unsigned char> pixels(static_cast<std::size_t>(pair.width * pair.height * 3));
  REQUIRE(png->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  for (int i = 0; i < pair.width * pair.height; ++i) {
    const int brightness = pixels[static_cast<std::size_t>(i * 3)] + pixels[static_cast<std::size_t>(i * 3 + 1)];
    const bool there = i == pair.y * pair.width + pair.x;
    REQUIRE((there ? brightness > 450 : brightness < 20));
  }
}
