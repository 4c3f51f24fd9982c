// dermis filter --view: light that enters where the camera does not look.
#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
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

const std::string layer = "ViewLayer.";
constexpr std::array colours = {".R", ".G", ".B"};
constexpr std::array axes = {".X", ".Y", ".Z"};

std::array<std::vector<float>, 3> planes(const Picture& picture, const std::string& pass,
                                         const std::array<const char*, 3>& ends) {
  return {picture.plane(layer + pass + ends[0]), picture.plane(layer + pass + ends[1]),
          picture.plane(layer + pass + ends[2])};
}

/// A ball, and its back: the picture turned by half about the vertical line through the middle of the ball.
struct Ball {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "front.0001.exr", "sphere", 61, 47, 3);
  Picture front = Picture::read(scene.path);
  std::string back = folder / "back.0001.exr";

  Ball() { turned(0).write(back); }

  /// The back, `closer` mm towards the camera.
  PictureCopy turned(float closer) const {
    auto position = planes(front, "Position", axes);
    auto normal = planes(front, "Normal", axes);
    const float twice_middle = 2 * middle_depth();
    for (std::size_t i = 0; i < position[0].size(); ++i) {
      position[0][i] *= -1;
      position[2][i] = twice_middle - position[2][i] - closer;
      normal[0][i] *= -1;
      normal[2][i] *= -1;
    }
    PictureCopy copy(scene.path);
    for (std::size_t k = 0; k < 3; ++k) {
      copy.with(layer + "Position" + axes[k], position[k]);
      copy.with(layer + "Normal" + axes[k], normal[k]);
    }
    return copy;
  }

  /// By two normals: a point of a ball is its middle and the radius times the normal.
  float middle_depth() const {
    const std::vector<float> id = front.plane(layer + "IndexMA.X");
    const auto position = planes(front, "Position", axes);
    const auto normal = planes(front, "Normal", axes);
    std::size_t left = id.size();
    std::size_t right = id.size();
    for (std::size_t i = 0; i < id.size(); ++i) {
      if (id[i] != 1) continue;
      if (left == id.size() || normal[0][i] < normal[0][left]) left = i;
      if (right == id.size() || normal[0][i] > normal[0][right]) right = i;
    }
    const float radius = (position[0][right] - position[0][left]) / (normal[0][right] - normal[0][left]);
    return position[2][left] - radius * normal[2][left];
  }

  Words call(const std::string& input, const std::string& output, const Words& more) const {
    Words arguments = {"--material", "1=burley:1/0.8/0.6"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return filter_arguments({input, scene.camera}, output, arguments);
  }

  Outcome filter(const std::string& output, const Words& more) const {
    return run_program(call(scene.path, folder / output, more));
  }

  double off(const std::string& a, const std::string& b, const std::string& pass = "sss") const {
    return relative_l2(folder / a, folder / b, layer + pass);
  }

  void check_refuses(const Words& more, int code, const Words& parts, const std::string& input = {}) const {
    check_refused(run_program(call(input.empty() ? scene.path : input, folder / "bad.exr", more)), code, parts);
    CHECK_FALSE(fs::exists(folder / "bad.exr"));
  }
};

nlohmann::json json_in(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

}  // namespace

TEST_CASE("--view adds the light that enters behind, and says how much it shows") {
  const Ball ball;
  CHECK(ball.filter("without.exr", {}).exit_code == 0);
  const Words with_view = {"--view",  ball.back,      "--view-factor",           "none",
                           "--stats", "--stats-json", ball.folder / "stats.json"};
  const Outcome outcome = ball.filter("with.exr", with_view);
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK_FALSE(has(outcome.errors, "warning"));
  CHECK(has(outcome.input, "--view " + ball.back + ": "));
  CHECK(has(outcome.input, " pixels of surface that the camera does not see, "));
  CHECK_FALSE(has(outcome.input, "view factor"));
  CHECK(has(outcome.output, "reached by views"));
  CHECK(has(outcome.output, "view        " + ball.back));
  CHECK(ball.off("with.exr", "without.exr") > 0.003);
  CHECK(has(bytes_of_file(ball.folder / "with.exr"), " --view back.0001.exr --view-factor none"));

  const nlohmann::json stats = json_in(ball.folder / "stats.json");
  CHECK(stats["times_ms"]["views"].get<double>() > 0);
  CHECK(stats["hidden_light"]["pixels"].get<int>() > 100);
  CHECK(stats["hidden_light"]["views"][0]["file"] == ball.back);
  CHECK(stats["hidden_light"]["views"][0]["hidden"].get<int>() > 100);
  CHECK(stats["hidden_light"]["views"][0]["contradicting"] == 0);

  // What the camera sees as well adds nothing, to the last bit.
  const Outcome same = ball.filter("same.exr", {"--view", ball.scene.path, "--view-factor", "none"});
  CHECK(same.exit_code == 0);
  CHECK(has(same.errors, "--view: no surface that only a view shows is within reach of any pixel"));
  CHECK(ball.off("same.exr", "without.exr") == 0);
  CHECK(ball.filter("strict.exr", {"--view", ball.scene.path, "--view-factor", "none", "--strict"}).exit_code == 4);
}

TEST_CASE("the beauty gains the albedo times what the light gains, with a view factor or without") {
  const Ball ball;
  const auto albedo = planes(ball.front, "DiffCol", colours);
  const auto before = planes(ball.front, "DiffDir", colours);
  const auto beauty = planes(ball.front, "Combined", colours);
  const std::vector<float> id = ball.front.plane(layer + "IndexMA.X");
  for (const std::string factor : {"none", "principled", "auto"}) {
    const Outcome outcome = ball.filter(factor + ".exr", {"--view", ball.back, "--view-factor", factor});
    INFO(outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK_FALSE(has(outcome.errors, "warning"));
    CHECK(has(outcome.input, "view factor: principled") == (factor != "none"));
    const Picture picture = Picture::read(ball.folder / (factor + ".exr"));
    const auto after = planes(picture, "sss", colours);
    const auto result = planes(picture, "Combined", colours);
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < id.size(); ++i) {
        if (id[i] == 1) {
          const double gain = static_cast<double>(albedo[c][i]) * (after[c][i] - before[c][i]);
          most = std::max(most, std::abs(static_cast<double>(result[c][i]) - beauty[c][i] - gain));
        } else {
          REQUIRE(result[c][i] == beauty[c][i]);
          REQUIRE(after[c][i] == before[c][i]);
        }
      }
    }
    CHECK(most < 1e-5);  // roundings of values of a few
  }
  CHECK(is_identical(ball.folder / "auto.exr", ball.folder / "principled.exr"));
  CHECK(ball.off("principled.exr", "none.exr") > 1e-3);
}

TEST_CASE("views that cannot be used are refused in one line") {
  const Ball ball;
  ball.check_refuses({"--view", ball.folder / "nosuch.exr"}, 3, {"nosuch.exr"});
  const std::string poor = ball.folder / "poor.exr";
  for (const auto& [pass, role] : {std::pair{"DiffDir", "light"},
                                   {"DiffCol", "albedo"},
                                   {"Position", "position"},
                                   {"Normal", "normal"},
                                   {"IndexMA", "material"}}) {
    ball.turned(0).without(layer + pass).write(poor);
    ball.check_refuses({"--view", poor, "--view-factor", "none"}, 5,
                       {"--view " + poor + ": got no " + std::string(role) + ", want a pass of "});
  }
  ball.turned(8).write(poor);
  ball.check_refuses({"--view", poor}, 4,
                     {"--view " + poor + ": got ", " % of its surface in front of what the camera sees"});
  ball.check_refuses({"--view", ball.folder / "back.####.exr", "--view-factor", "none"}, 5, {"--view: got "}, [&] {
    PictureCopy(ball.scene.path).without(layer + "Position").write(ball.folder / "nowhere.0001.exr");
    return ball.folder / "nowhere.0001.exr";
  }());
  fs::copy_file(ball.scene.path, ball.folder / "plain.exr");
  ball.check_refuses({"--view", ball.folder / "back.####.exr"}, 2,
                     {"--view: got ", "which has no number", "a picture with the number of a frame"},
                     ball.folder / "plain.exr");
  ball.check_refuses({"--view", ball.back, "--translucency", "--lights", ball.folder / "lights.json"}, 2,
                     {"--translucency: got it with --view " + ball.back, "want one of the two"});
  ball.check_refuses({"--view", ball.back, "--view-factor", "some"}, 2, {"--view-factor", "auto", "principled"});
  ball.check_refuses({"--view-factor", "principled"}, 5, {"normal"}, [&] {
    PictureCopy(ball.scene.path).without(layer + "Normal").write(ball.folder / "smooth.exr");
    return ball.folder / "smooth.exr";
  }());
}

TEST_CASE("each picture of a sequence has its own view, and warm knows them") {
  const Ball ball;
  const std::string second = ball.folder / "front.0002.exr";
  fs::copy_file(ball.scene.path, second);
  auto brighter = ball.turned(0);
  for (const char* end : colours) {
    std::vector<float> light = ball.front.plane(layer + "DiffDir" + end);
    for (float& value : light) value *= 3;
    brighter.with(layer + "DiffDir" + end, light);
  }
  brighter.write(ball.folder / "back.0002.exr");
  fs::create_directory(ball.folder / "out");
  Words arguments = ball.call(ball.scene.path, ball.folder / "out", {"--view", ball.folder / "back.####.exr"});
  arguments.insert(arguments.end(), {second, "--reuse"});
  run_well(arguments);
  CHECK(ball.filter("1.exr", {"--view", ball.back}).exit_code == 0);
  CHECK(ball.filter("2.exr", {"--view", ball.folder / "back.0002.exr"}).exit_code == 0);
  CHECK(ball.off("out/front.0001.exr", "1.exr") == 0);
  CHECK(ball.off("out/front.0002.exr", "2.exr") == 0);
  CHECK(ball.off("1.exr", "2.exr") > 1e-3);

  const Words warm = {"warm", "--mm-per-unit", "1", "--material", "1=burley:1/0.8/0.6", "--view", ball.back};
  CHECK(run_well(warm).starts_with("ready after "));
  Words warm_for = warm;
  warm_for.push_back(ball.scene.path);
  CHECK(run_well(warm_for).starts_with("ready after "));
}

TEST_CASE("a random walk gains by the curvature that normals tell, and the program says so") {
  const Ball ball;
  const auto filter = [&](const std::string& output, const std::string& profile, Words more) {
    more.insert(more.begin(), {"--material", "1=" + profile, "--quality", "draft", "--view-factor", "none"});
    return run_program(filter_arguments({ball.scene.path, ball.scene.camera}, ball.folder / output, more));
  };
  const std::string walk = "walk:9/6/4,albedo=0.8/0.6/0.4";
  const Outcome with = filter("with.exr", walk, {});
  CHECK(with.exit_code == 0);
  CHECK(has(with.input, "curvature: by the normals"));
  const Outcome off = filter("off.exr", walk, {"--curvature", "off"});
  CHECK_FALSE(has(off.input, "curvature"));
  CHECK(ball.off("with.exr", "off.exr") > 0.01);
  const Outcome without = filter("without.exr", walk, {"--role", "normal="});
  CHECK(has(without.input, "curvature: none, as there are no normals"));
  CHECK(ball.off("without.exr", "off.exr") == 0);
  CHECK_FALSE(has(filter("burley.exr", "burley:9/6/4,cycles", {}).input, "curvature"));
}

TEST_CASE("--view-report draws which pixels get light and from which view") {
  const Ball ball;
  const std::string png = ball.folder / "views.png";
  const Words views = {"--view", ball.back, "--view", ball.scene.path, "--view-factor", "none"};
  Words with_report = views;
  with_report.insert(with_report.end(), {"--view-report", png});
  const Outcome outcome = ball.filter("with.exr", with_report);
  INFO(outcome.errors << outcome.output);
  CHECK(outcome.exit_code == 0);
  CHECK(ball.filter("plain.exr", views).exit_code == 0);
  CHECK(is_identical(ball.folder / "with.exr", ball.folder / "plain.exr"));
  // The first view brings light to the rim, the second shows what the camera sees as well and brings none.
  const auto count_of = [&](const std::string& colour) {
    const std::size_t at = outcome.output.find("\n  " + colour + " ");
    REQUIRE(at != std::string::npos);
    return std::stoi(outcome.output.substr(at + 3 + colour.size()));
  };
  const int counted = count_of("orange");
  CHECK(counted > 50);
  CHECK(count_of("blue") == 0);
  OIIO::ImageBuf image(png);
  REQUIRE(image.read());
  int orange = 0;
  for (int y = 0; y < image.spec().height; ++y) {
    for (int x = 0; x < image.spec().width; ++x) {
      std::array<float, 3> rgb{};
      image.getpixel(x, y, rgb.data(), 3);
      CHECK(rgb[2] <= std::max(rgb[0], rgb[1]));
      if (rgb[0] > rgb[2]) ++orange;
    }
  }
  CHECK(orange >= counted);
  ball.check_refuses({"--view-report", png}, 2,
                     {"--view-report: got " + png + " without --view", "a view to report on"});
}

TEST_CASE("info --views tells how much the camera does not see") {
  const Ball ball;
  const auto info = [&](Words more) {
    more.insert(more.begin(), {"info", ball.scene.path, "--views", "--json"});
    more.insert(more.end(), ball.scene.camera.begin(), ball.scene.camera.end());
    return run_program(more);
  };
  const auto share = [&](const std::string& profile) {
    const Outcome outcome = info({"--material", "1=" + profile});
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json told = nlohmann::json::parse(outcome.output);
    for (const nlohmann::json& its : told["materials"]) {
      if (its["id"] != 1) continue;
      CHECK(its["unseen"]["pixels_missing"].get<double>() <= 1);
      return its["unseen"]["mean_share"].get<double>();
    }
    return -1.0;
  };
  // The wider the profile, the more of it lies beyond the rim.
  const double narrow = share("burley:0.2/0.2/0.2");
  const double wide = share("burley:2/2/2");
  CHECK(narrow >= 0);
  CHECK(narrow < 0.1);
  CHECK(wide > 2 * narrow);
  CHECK(wide < 1);
  check_refused(info({}), 2, {"--views: got it without --material and --profile"});
}
