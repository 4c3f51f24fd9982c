// Cameras from --camera FILE, and --depth-type.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using nlohmann::json;
using Words = std::vector<std::string>;

namespace {

std::string file(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder / "camera.json";
  std::ofstream(path) << text;
  return path;
}

}  // namespace

TEST_CASE("a camera may stand in a file beside the picture") {
  const TemporaryFolder folder;
  make_scene(folder / "in.exr", "tilted", 40, 30, 4);
  PictureCopy(folder / "in.exr").without("ViewLayer.Position").write(folder / "less.exr");
  const auto camera = [&](const std::string& text) {
    return json::parse(run_well(
        {"info", folder / "less.exr", "--json", "--depth-type", "z", "--camera", file(folder, text)}))["camera"];
  };
  CHECK(camera(R"({"focal_px": 77})")["scale_x"] == 77);
  CHECK(camera(R"({"fov_deg": 90})")["scale_x"].get<double>() == Approx(20));
  CHECK(camera(R"({"focal_mm": 50, "sensor_width_mm": 36})")["scale_x"].get<double>() == Approx(40 * 50.0 / 36));
  CHECK(camera(R"({"px_per_unit": 3})")["projection"] == "orthographic");
  const json by_matrices = camera(R"({"worldToCamera": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
                                      "worldToNDC": [2,0,0,0, 0,-2,0,0, 0.5,0.5,1,1, 0,0,-1,0]})");
  CHECK(by_matrices["scale_x"].get<double>() == Approx(80));
  CHECK(by_matrices["scale_y"].get<double>() == Approx(60));
  CHECK(by_matrices["source"].get<std::string>().starts_with("--camera "));
}

TEST_CASE("a camera file or a depth type with anything else in it is refused") {
  const TemporaryFolder folder;
  make_scene(folder / "in.exr", "tilted", 40, 30, 4);
  const auto refused = [&](const Words& more, int code, const Words& parts) {
    Words call = {"info", folder / "in.exr"};
    call.insert(call.end(), more.begin(), more.end());
    check_refused(run_program(call), code, parts);
  };
  for (const char* text : {"{}", "[]", R"({"fov": 40})", R"({"fov_deg": 40, "focal_px": 3})", R"({"focal_mm": 50})"})
    refused({"--camera", file(folder, text)}, 4, {"--camera", "camera.json", "focal_mm, sensor_width_mm"});
  refused({"--camera", file(folder, R"({"fov_deg": 190})")}, 4, {"fov_deg", "190", "below 180"});
  refused({"--camera", file(folder, R"({"worldToCamera": [1], "worldToNDC": []})")}, 4, {"worldToCamera", "16 finite"});
  refused({"--camera", file(folder, "{")}, 4, {"--camera", "camera.json", "JSON"});
  refused({"--camera", folder / "none.json"}, 3, {"--camera", "none.json"});
  for (const char* text : {"depth", "z:1,2", "normalized", "normalized:1", "normalized:2,2", "normalized:a,b", ""})
    refused({"--depth-type", text}, 2, {"--depth-type", "normalized:NEAR,FAR"});
}
