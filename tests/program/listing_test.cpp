// The commands that tell: info, devices, profiles, scene, help.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/profile.hpp"
#include "dermis/version.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using dermis::exr::Picture;
using nlohmann::json;

namespace {

const std::string sample = std::string(DERMIS_DATA) + "/monkey_gbuffer.exr";

std::map<int, int> count_ids(const std::string& path) {
  std::map<int, int> counts;
  for (const float id : Picture::read(path).plane("ViewLayer.IndexMA.X")) ++counts[static_cast<int>(id)];
  return counts;
}

}  // namespace

TEST_CASE("help and version are no errors") {
  CHECK(run_well({"--version"}) == "dermis " DERMIS_VERSION "\n");
  const std::string help = run_well({"--help"});
  for (const char* command : {"filter", "texture", "compare-methods", "sheet", "light", "info", "devices", "profiles",
                              "compare", "scene", "Exit codes"})
    CHECK(has(help, command));
  const std::string filter = run_well({"filter", "--help"});
  for (const char* option : {"--model",       "--rank",         "--taps",       "--placement",
                             "--guide",       "--non-negative", "--tolerance",  "--material",
                             "--profile",     "--method",       "--jitter",     "--seed",
                             "--lighting",    "--albedo-mix",   "--fov",        "--focal-px",
                             "--px-per-unit", "--mm-per-unit",  "--role",       "--layer",
                             "--compression", "--device",       "--threads",    "--stats",
                             "--stats-json",  "--preview",      "--output",     "gaussians:FILE.json",
                             "--quality",     "--tile-map",     "--bad-pixels", "--samples",
                             "--disc",        "--prefilter",    "--accumulate"}) {
    INFO(option);
    CHECK(has(filter, option));
  }
}

TEST_CASE("help comes in groups that fit a screen, the usual options first") {
  for (const std::string command : {"filter", "texture", "taps", "compare-methods", "sheet"}) {
    std::istringstream help(run_well({command, "--help"}));
    std::vector<std::string> groups;
    int lines = 0;
    for (std::string line; std::getline(help, line); ++lines) {
      CAPTURE(command, groups, line);
      CHECK(line.size() <= 100);
      CHECK(lines < 24);
      if (!line.empty() && line.front() != ' ' && line.back() == ':') groups.push_back(line);
      if (line.empty()) lines = -1;
    }
    REQUIRE(groups.size() >= 3);
    CHECK(groups[0] == "Positionals:");
    CHECK(groups[1] == (command == "taps" ? "Design:" : "Usual options:"));
  }
  const std::string filter = run_well({"filter", "--help"});
  CHECK(filter.find("--mm-per-unit") < filter.find("--quality"));
  CHECK(filter.find("--quality") < filter.find("--fov"));
  CHECK(filter.find("--fov") < filter.find("--rank"));
  CHECK(has(filter, "--quality draft|preview|final|reference"));
  CHECK(filter.find("PROFILE is one of") > filter.find("--threads"));
}

TEST_CASE("results that cannot be printed are an error") {
  if (!std::filesystem::exists("/dev/full")) return;
  const std::string command = std::string("'") + DERMIS_PROGRAM + "' profiles >/dev/full 2>/dev/null";
  CHECK(std::system(command.c_str()) == 6 << 8);
}

TEST_CASE("info tells what the sample holds") {
  const json info = json::parse(
      run_well({"info", sample, "--json", "--mm-per-unit", "10", "--material", "1=skin", "--material", "2=marble"}));
  CHECK(info["width"] == 960);
  CHECK(info["height"] == 540);
  CHECK(info["data_window"] == json({{"x", 0}, {"y", 0}, {"width", 960}, {"height", 540}}));
  CHECK(info["compression"] == "dwaa");
  CHECK(info["channels"] == 30);
  CHECK(info["roles"]["layer"] == "ViewLayer");
  CHECK(info["roles"]["light"].size() == 2);
  CHECK(info["roles"]["material"] == json({{"ViewLayer.IndexMA.X"}}));
  CHECK(info["roles"]["mask"].is_null());
  CHECK(info["camera"]["projection"] == "perspective");
  CHECK(info["camera"]["source"] == "position and depth");
  // a 50 mm lens before a 36 mm sensor
  CHECK(info["camera"]["scale_x"].get<double>() == Approx(960 * 50 / 36.0).epsilon(1e-3));

  const std::map<int, int> counts = count_ids(sample);
  REQUIRE(info["materials"].size() == counts.size());
  for (const json& material : info["materials"]) {
    const int id = material["id"];
    CHECK(material["pixels"] == counts.at(id));
    CHECK(material.contains("radius_px") == (id == 1 || id == 2));
    if (id != 1) continue;
    const double px_per_mm =
        info["camera"]["scale_x"].get<double>() / (10 * material["median_depth_units"].get<double>());
    CHECK(material["radius_px"][0].get<double>() ==
          Approx(material["radius_mm"].get<double>() * px_per_mm).epsilon(1e-9));
    CHECK(material["radius_px"][0] > 1.0);
  }
  CHECK(info["device_memory_bytes"]["working"] > 960 * 540 * 4);

  const std::string text = run_well({"info", sample});
  for (const char* part : {"960 x 540", "dwaa", "ViewLayer.DiffDir.{R,G,B} + ViewLayer.DiffInd.{R,G,B}", "missing",
                           "perspective", "position and depth"}) {
    INFO(part);
    CHECK(has(text, part));
  }
}

TEST_CASE("info tells what is missing, and that is no error") {
  const TemporaryFolder folder;
  make_scene(folder / "in.exr", "step", 20, 20, 4);
  PictureCopy(folder / "in.exr").without("ViewLayer.Position").without("ViewLayer.DiffDir").write(folder / "less.exr");
  const json info = json::parse(run_well({"info", folder / "less.exr", "--json"}));
  CHECK(info["roles"]["light"].is_null());
  CHECK(info["camera"].is_null());
  CHECK(has(info["camera_problem"], "camera"));
  CHECK(has(run_well({"info", folder / "less.exr"}), "light         missing"));
  const json told = json::parse(run_well({"info", folder / "less.exr", "--json", "--fov", "40", "--depth-type", "z"}));
  CHECK(told["camera"]["scale_x"].get<double>() == Approx(10 / std::tan(20 * 3.14159265358979323846 / 180)));
  CHECK(told["camera"]["depth_type"] == "z");
  check_refused(run_program({"info", folder / "less.exr", "--fov", "nan"}), 2, {"--fov: got nan"});
}

TEST_CASE("info needs no device") {
  const TemporaryFolder folder;
  make_scene(folder / "in.exr", "sphere", 20, 20, 4);
  const Outcome outcome =
      run_program({"info", folder / "in.exr", "--json"}, {"OCL_ICD_VENDORS=" + (folder / "nosuch")});
  REQUIRE(outcome.exit_code == 0);
  CHECK(json::parse(outcome.output)["device_memory_bytes"].is_null());
}

TEST_CASE("devices are listed by number") { CHECK(run_well({"devices"}).starts_with("0  ")); }

TEST_CASE("profiles are listed with their sources, and drawn") {
  const std::string table = run_well({"profiles"});
  for (const dermis::Preset& preset : dermis::presets()) {
    CHECK(has(table, preset.name));
    CHECK(has(table, preset.source));
  }
  const TemporaryFolder folder;
  const Outcome without = run_program({"profiles", "--plot", folder / "plot.svg"}, {"PATH=" + (folder / "nosuch")});
  check_refused(without, 6, {"--plot", "gnuplot"});
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) return;
  const std::string quoted = folder / "it's a plot.svg";
  run_well({"profiles", "--plot", quoted});
  std::ifstream file(quoted);
  const std::string svg{std::istreambuf_iterator<char>(file), {}};
  CHECK(has(svg, "<svg"));
  CHECK(has(svg, "skin"));
  run_well({"profiles", "--plot", folder / "plot.png"});
  CHECK(std::filesystem::file_size(folder / "plot.png") > 1000);
}

TEST_CASE("every scene can be written") {
  const TemporaryFolder folder;
  for (const char* name : {"impulse", "step", "tilted", "sphere", "touching"}) {
    INFO(name);
    const MadeScene scene = make_scene(folder / "in.exr", name, 19, 13, 3);
    const Picture picture = Picture::read(scene.path);
    CHECK(picture.width() == 19);
    CHECK(picture.height() == 13);
    CHECK(picture.channels().size() == 17);
    for (const char* channel :
         {"ViewLayer.Combined.R", "ViewLayer.DiffDir.G", "ViewLayer.DiffCol.B", "ViewLayer.Depth.Z",
          "ViewLayer.Position.X", "ViewLayer.Normal.Y", "ViewLayer.IndexMA.X"})
      CHECK(picture.find(channel) != nullptr);
  }
}
