// dermis filter --tile-map: a picture of what became of each block, and what its colours mean.
#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

const std::array names = {"without material", "narrow", "unlit", "uniform", "flat", "curved", "reused", "mixed"};

/// The line of the legend for one kind.
struct LegendLine {
  std::string colour;
  int blocks = 0;
  double percent = 0;
};

LegendLine line_of(const std::string& legend, const std::string& name) {
  const std::size_t at = legend.find("\n  " + name + " ");
  INFO("legend: " << legend);
  REQUIRE(at != std::string::npos);
  std::istringstream words(legend.substr(at + 3 + name.size()));
  LegendLine line;
  words >> line.colour >> line.blocks >> line.percent;
  return line;
}

/// The channels that a colour has most of, by their ratios: the brightness of a pixel is that of the light.
std::string colour_of(const std::array<float, 3>& rgb) {
  const auto [r, g, b] = rgb;
  if (r == g && g == b) return "grey";
  if (r > 2 * b && g > 2 * b) return "yellow";
  if (g > 2 * r && b > 2 * r && g == b) return "cyan";
  if (r > 2 * g && b > 2 * g && r < 2 * b) return "magenta";
  if (r > g && r > b) return "red";
  return g > b ? "green" : "blue";
}

}  // namespace

TEST_CASE("the tile map has a colour for each kind of block, and a legend") {
  const TemporaryFolder folder;
  // A step: material 1 under light that is uniform on the left and on the right of an edge.
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 330, 100, 4);
  const std::string png = folder / "tiles.png";
  const std::string legend = run_well(filter_arguments(
      scene, folder / "out.exr",
      {"--material", "1=burley:0.5/0.4/0.3", "--tile-map", png, "--stats-json", folder / "stats.json"}));
  std::ifstream file(folder / "stats.json");
  const nlohmann::json stats = nlohmann::json::parse(file);
  int total = 0;
  double percent = 0;
  std::vector<std::string> expected;
  for (const std::string name : names) {
    const LegendLine line = line_of(legend, name);
    std::string key = name;
    std::replace(key.begin(), key.end(), ' ', '_');
    CHECK(line.blocks == stats["blocks"][key]);
    total += line.blocks;
    percent += line.percent;
    if (line.blocks > 0) expected.push_back(line.colour);
  }
  REQUIRE(total > 0);
  CHECK(total == stats["blocks"]["total"]);
  CHECK(percent == Approx(100).margin(0.4));  // eight numbers rounded to a tenth

  OIIO::ImageBuf image(png);
  REQUIRE(image.read());
  REQUIRE(image.spec().width == 330);
  REQUIRE(image.spec().height == 100);
  std::vector<std::string> found;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 330; ++x) {
      std::array<float, 3> rgb{};
      image.getpixel(x, y, rgb.data(), 3);
      REQUIRE(std::max({rgb[0], rgb[1], rgb[2]}) > 0.1F);
      const std::string colour = colour_of(rgb);
      if (std::find(found.begin(), found.end(), colour) == found.end()) found.push_back(colour);
    }
  }
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  CHECK(found == expected);

  // The result is the same as without.
  run_well(filter_arguments(scene, folder / "plain.exr", {"--material", "1=burley:0.5/0.4/0.3"}));
  CHECK(is_identical(folder / "plain.exr", folder / "out.exr"));
  for (const auto& entry : fs::directory_iterator(folder.path())) CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("blocks that have nothing to do are grey, those with kernels below a pixel cyan") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 50, 40, 4);
  const auto legend = [&](const std::string& material) {
    const Outcome outcome = run_program(filter_arguments(
        scene, folder / "out.exr", {"--material", material, "--tile-map", folder / "t.png", "--allow-empty"}));
    REQUIRE(outcome.exit_code == 0);
    return outcome.output;
  };
  CHECK(line_of(legend("77=skin"), "without material").percent == 100);
  CHECK(line_of(legend("77=skin"), "without material").colour == "grey");
  CHECK(line_of(legend("1=burley:0.001/0.001/0.001"), "narrow").percent == 100);
  OIIO::ImageBuf image(folder / "t.png");
  REQUIRE(image.read());
  std::array<float, 3> rgb{};
  image.getpixel(25, 20, rgb.data(), 3);
  CHECK(colour_of(rgb) == "cyan");
}

TEST_CASE("the tile map takes the place of no other file") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const std::string png = folder / "p.png";
  check_refused(run_program(filter_arguments(scene, folder / "out.exr",
                                             {"--material", "1=skin", "--preview", png, "--tile-map", png})),
                2, {"--tile-map: got", "not --preview as well"});
  CHECK_FALSE(fs::exists(folder / "out.exr"));
  CHECK_FALSE(fs::exists(png));
}

TEST_CASE("a tolerance that takes the exact method leaves no blocks to draw") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const Outcome outcome = run_program(filter_arguments(
      scene, folder / "out.exr", {"--material", "1=skin", "--tolerance", "0.000001", "--tile-map", folder / "t.png"}));
  CHECK(outcome.exit_code == 2);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.find("--tile-map: got") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "out.exr"));
  CHECK_FALSE(fs::exists(folder / "t.png"));
}
