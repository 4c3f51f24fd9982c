// dermis filter with all designs of taps: by name, or by a tolerance.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "dermis/profile.hpp"
#include "dermis/taps.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using dermis::TapsDesign;
using dermis::exr::Picture;
using nlohmann::json;
using Words = std::vector<std::string>;

namespace {

constexpr std::array channels = {"R", "G", "B"};
constexpr std::array constant = {0.7F, 0.2F, 3.1F};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Two materials: stripes of light on 1, constant light on 2. The albedo is 1.
MadeScene striped_and_constant(const TemporaryFolder& folder) {
  constexpr int width = 70;
  MadeScene scene = make_scene(folder / "plain.exr", "touching", width, 41, 3);
  const std::vector<float> ids = Picture::read(scene.path).plane("ViewLayer.IndexMA.X");
  PictureCopy copy(scene.path);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> light(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
      light[i] = ids[i] == 2 ? constant[c] : (i % width / 7 + i / width / 5) % 2 == 0 ? 2.0F : 0.25F;
    copy.with(std::string("ViewLayer.DiffDir.") + channels[c], light);
    copy.with(std::string("ViewLayer.DiffCol.") + channels[c], std::vector<float>(ids.size(), 1));
  }
  scene.path = folder / "in.exr";
  copy.write(scene.path);
  return scene;
}

/// The relative L2 distance over the pixels of material 1.
double distance(const std::string& a, const std::string& prefix_a, const std::string& b, const std::string& prefix_b) {
  const Picture picture_a = Picture::read(a);
  const Picture picture_b = Picture::read(b);
  const std::vector<float> ids = picture_a.plane("ViewLayer.IndexMA.X");
  double error = 0;
  double truth = 0;
  for (const char* c : channels) {
    const std::vector<float> values = picture_a.plane(prefix_a + c);
    const std::vector<float> expected = picture_b.plane(prefix_b + c);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != 1) continue;
      error += std::pow(static_cast<double>(values[i]) - expected[i], 2);
      truth += std::pow(static_cast<double>(expected[i]), 2);
    }
  }
  return std::sqrt(error / truth);
}

/// The greatest relative difference of the pixels of material 2 from the constant.
double change_of_constant(const std::string& path) {
  const Picture picture = Picture::read(path);
  const std::vector<float> ids = picture.plane("ViewLayer.IndexMA.X");
  double most = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> values = picture.plane(std::string("ViewLayer.sss.") + channels[c]);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == 2) most = std::max(most, std::abs(static_cast<double>(values[i]) / constant[c] - 1));
  }
  return most;
}

json stats_of(const Words& call) { return json::parse(run_well(with(call, {"--stats-json", "-"}))); }

int reads_of(const json& design) { return (1 + design["rank"].get<int>()) * design["taps"].get<int>(); }

void check_is(const json& design, const TapsDesign& expected) {
  CHECK(design["rank"] == expected.rank);
  CHECK(design["taps"] == expected.count);
  CHECK(design["non_negative"] == expected.non_negative);
  const std::array models = {"pre-integrated", "artist", "guided", "svd", "gaussians", "optimised"};
  CHECK(design["model"] == models.at(static_cast<std::size_t>(expected.model)));
  const std::array placements = {"uniform", "importance", "quadratic", "optimised"};
  CHECK(design["placement"] == placements.at(static_cast<std::size_t>(expected.placement)));
  CHECK(design["guide"].is_null() == (expected.model != dermis::Model::guided));
}

std::string record_of(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  REQUIRE(input);
  return input->spec().get_string_attribute("dermis:command");
}

}  // namespace

TEST_CASE("every model of every rank spreads light, and leaves constant light as it is") {
  const TemporaryFolder folder;
  const MadeScene scene = striped_and_constant(folder);
  const Words materials = {"--material", "1=burley:0.5/0.4/0.3", "--material", "2=burley:0.5/0.4/0.3"};
  const auto call = [&](const std::string& name, const Words& more) {
    return filter_arguments(scene, folder / name, with(materials, more));
  };
  run_well(call("exact.exr", {"--method", "exact"}));
  const double unfiltered = distance(scene.path, "ViewLayer.DiffDir.", folder / "exact.exr", "ViewLayer.sss.");
  CHECK(unfiltered > 0.1);

  struct Case {
    Words design;
    int rank;
  };
  const std::vector<Case> cases = {
      {{"--model", "pre-integrated"}, 1},
      {{"--model", "artist"}, 1},
      {{"--model", "guided"}, 1},
      {{"--model", "guided", "--guide", "0.5"}, 1},
      {{"--model", "svd", "--rank", "1"}, 1},
      {{"--model", "svd", "--rank", "2"}, 2},
      {{"--model", "svd", "--rank", "3"}, 3},
      {{"--model", "gaussians", "--rank", "1"}, 1},
      {{"--model", "gaussians", "--rank", "2"}, 2},
      {{"--model", "gaussians", "--rank", "3"}, 3},
      {{"--model", "gaussians", "--rank", "6"}, 6},
      {{"--model", "optimised", "--rank", "1"}, 1},
      {{"--model", "optimised", "--rank", "2"}, 2},
      {{"--model", "optimised", "--rank", "3"}, 3},
      {{"--model", "optimised", "--rank", "3", "--non-negative"}, 3},
      {{"--model", "optimised", "--rank", "1", "--placement", "uniform"}, 1},
      {{"--model", "optimised", "--rank", "1", "--placement", "importance"}, 1},
      {{"--model", "optimised", "--rank", "1", "--placement", "quadratic"}, 1},
  };
  Words outputs;
  for (const Case& c : cases) {
    std::string name;
    for (const std::string& word : c.design) name += word;
    INFO(name);
    const json stats = stats_of(call(name + ".exr", with(c.design, {"--taps", "13"})));
    CHECK(stats["materials"][0]["design"]["model"] == c.design[1]);
    CHECK(stats["materials"][0]["design"]["rank"] == c.rank);
    CHECK(stats["materials"][0]["design"]["taps"] == 13);
    const std::string output = folder / (name + ".exr");
    // A filter that spreads nothing is at 1 of it; the worst of these, 13 uniform taps, at 0.43.
    CHECK(distance(output, "ViewLayer.sss.", folder / "exact.exr", "ViewLayer.sss.") < 0.5 * unfiltered);
    // A pass sums 13 weights and 13 products and divides: (2 * 13 + 1) 2^-24 of the light. There are two, of up to
    // 6 terms whose scales sum to 1; where they change their sign, their absolute values sum to less than 4.
    CHECK(change_of_constant(output) <= 2 * 27 * 4 * std::ldexp(1.0, -24));
    for (const std::string& other : outputs) {
      INFO(other);
      CHECK_FALSE(is_identical(output, other));
    }
    outputs.push_back(output);
  }
}

TEST_CASE("a design that is asked for in part is that of the library in all else") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 31, 20, 4);
  const TapsDesign expected = dermis::Options{}.taps;
  const Words call = {"--material", "1=skin", "--rank", std::to_string(expected.rank)};
  const json stats = stats_of(filter_arguments(scene, folder / "out.exr", call));
  const json& material = stats["materials"][0];
  check_is(material["design"], expected);
  CHECK(material["design"]["most_taps"] == expected.count);
  CHECK(stats["tolerance"].is_null());
  CHECK(stats["quality"].is_null());
  CHECK(stats["method"] == "separable");
  // The step is parallel to the screen: 4 pixels per mm everywhere.
  CHECK(material["pixel_mm"].get<double>() == Approx(0.25).epsilon(1e-6));
  const auto set = make_tap_set(dermis::preset("skin").profile, expected, material["pixel_mm"]);
  CHECK(material["design"]["predicted_rel_l2"].get<double>() == Approx(set.predicted_rel_l2).epsilon(1e-9));
  const std::string table = run_well(filter_arguments(scene, folder / "out.exr", with(call, {"--stats"})));
  std::ostringstream expected_text;
  expected_text << "rank " << expected.rank << ", " << expected.count << " taps";
  CHECK(table.find(expected_text.str()) != std::string::npos);
  CHECK(table.find("for pixels of 0.25 mm") != std::string::npos);
}

TEST_CASE("a tolerance takes no more taps and terms than it needs, for each material") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 50, 30, 4);
  const Words materials = {"--material", "1=skin", "--material", "2=burley:2/1/0.5"};
  std::array<std::vector<int>, 2> reads;
  for (const double tolerance : {0.2, 0.02, 0.004}) {
    std::ostringstream text;
    text << tolerance;
    INFO("tolerance " << tolerance);
    const json stats =
        stats_of(filter_arguments(scene, folder / "out.exr", with(materials, {"--tolerance", text.str()})));
    CHECK(stats["tolerance"] == tolerance);
    CHECK(stats["quality"].is_null());
    CHECK(stats["method"] == "separable");
    for (std::size_t m = 0; m < 2; ++m) {
      INFO("material " << m + 1);
      const json& design = stats["materials"][m]["design"];
      CHECK(design["predicted_rel_l2"] <= tolerance);
      CHECK(design["taps"] <= design["most_taps"]);
      reads[m].push_back(reads_of(design));
    }
  }
  for (const auto& of_material : reads) {
    CHECK(std::is_sorted(of_material.begin(), of_material.end()));
    CHECK(of_material.front() < of_material.back());
  }
}

TEST_CASE("a quality is a tolerance, and the default is final") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 50, 30, 8);
  const auto call = [&](const std::string& name, const Words& more) {
    return filter_arguments(scene, folder / name, with({"--material", "1=skin"}, more));
  };
  run_well(call("reference.exr", {"--quality", "reference"}));
  run_well(call("exact.exr", {"--method", "exact"}));
  CHECK(is_identical(folder / "reference.exr", folder / "exact.exr"));
  struct Case {
    std::string quality;
    std::string tolerance;
  };
  double worse = 1;
  for (const Case& c : {Case{"draft", "0.05"}, Case{"preview", "0.02"}, Case{"final", "0.006"}}) {
    INFO(c.quality);
    const json stats = stats_of(call("quality.exr", {"--quality", c.quality}));
    CHECK(stats["quality"] == c.quality);
    CHECK(stats["tolerance"] == std::stod(c.tolerance));
    run_well(call("tolerance.exr", {"--tolerance", c.tolerance}));
    CHECK(is_identical(folder / "quality.exr", folder / "tolerance.exr"));
    const double error = relative_l2(folder / "quality.exr", folder / "reference.exr", "ViewLayer.sss");
    CHECK(error < worse);
    worse = error;
  }
  for (const Words& words : {Words{}, Words{"--taps", "auto"}, Words{"--rank", "auto", "--taps", "auto"}}) {
    run_well(call("default.exr", words));
    CHECK(is_identical(folder / "default.exr", folder / "quality.exr"));
  }
}

TEST_CASE("a tolerance leaves alone what is asked for beside it") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 50, 30, 4);
  const json stats = stats_of(filter_arguments(
      scene, folder / "out.exr",
      {"--material", "1=skin", "--tolerance", "0.2", "--rank", "3", "--placement", "importance", "--non-negative"}));
  const json& design = stats["materials"][0]["design"];
  CHECK(design["rank"] == 3);
  CHECK(design["placement"] == "importance");
  CHECK(design["non_negative"] == true);
  CHECK(design["taps"] < design["most_taps"]);
}

TEST_CASE("a tolerance that no taps meet takes the exact method, and says so") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 30, 20, 4);
  const Words materials = {"--material", "1=skin", "--material", "2=burley:2/1/0.5"};
  const Outcome outcome = run_program(filter_arguments(
      scene, folder / "out.exr", with(materials, {"--tolerance", "0.000001", "--stats-json", folder / "stats.json"})));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.output.empty());
  CHECK(outcome.errors.starts_with("dermis: note: --tolerance 1e-06: "));
  CHECK(outcome.errors.find("--material 2") != std::string::npos);
  CHECK(outcome.errors.find("the method is exact") != std::string::npos);
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  run_well(filter_arguments(scene, folder / "exact.exr", with(materials, {"--method", "exact"})));
  CHECK(is_identical(folder / "out.exr", folder / "exact.exr"));
  run_well(filter_arguments(scene, folder / "taps.exr", materials));
  CHECK_FALSE(is_identical(folder / "taps.exr", folder / "exact.exr"));

  std::ifstream file(folder / "stats.json");
  const json stats = json::parse(file);
  CHECK(stats["method"] == "exact");
  CHECK(stats["tolerance"] == 0.000001);
  for (const json& material : stats["materials"]) {
    CHECK(material["design"].is_null());
    CHECK(material["pixel_mm"].get<double>() == Approx(0.25).epsilon(1e-6));
  }
}

TEST_CASE("a material that no pixel has does not ask for a design") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const Outcome outcome = run_program(filter_arguments(scene, folder / "out.exr",
                                                       {"--material", "1=skin", "--material", "77=burley:2/1/0.5",
                                                        "--tolerance", "0.05", "--stats-json", folder / "stats.json"}));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors == "dermis: warning: " + scene.path + ": --material 77: no pixel is of this material\n");
  std::ifstream file(folder / "stats.json");
  const json stats = json::parse(file);
  CHECK(stats["materials"][0]["design"]["predicted_rel_l2"] <= 0.05);
  CHECK(stats["materials"][1]["pixel_mm"].is_null());
  CHECK(stats["materials"][1]["design"]["predicted_rel_l2"].is_null());
}

TEST_CASE("the size of a pixel is that at the median depth, along the axis with more of them") {
  const TemporaryFolder folder;
  const auto pixel_mm = [&](const std::string& path, const Words& more) {
    const Words call = with({"filter", path, "-o", folder / "out.exr", "--material", "1=skin"}, more);
    return stats_of(call)["materials"][0]["pixel_mm"].get<double>();
  };
  SECTION("orthographic") {
    const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4, true);
    CHECK(pixel_mm(scene.path, scene.camera) == Approx(0.25).epsilon(1e-6));
    CHECK(pixel_mm(scene.path, {"--px-per-unit", "5", "--mm-per-unit", "10"}) == Approx(2));
  }
  SECTION("perspective") {
    const MadeScene scene = make_scene(folder / "in.exr", "sphere", 41, 33, 4);
    const Picture picture = Picture::read(scene.path);
    const std::vector<float> ids = picture.plane("ViewLayer.IndexMA.X");
    std::vector<float> depth = picture.plane("ViewLayer.Depth.Z");
    std::vector<float> own;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == 1) own.push_back(depth[i]);
    const auto middle = own.begin() + static_cast<std::ptrdiff_t>(own.size() / 2);
    std::nth_element(own.begin(), middle, own.end());
    const double focal_px = std::stod(scene.camera[1]);
    CHECK(pixel_mm(scene.path, {"--mm-per-unit", "10"}) == Approx(*middle * 10 / focal_px).epsilon(1e-3));
    // A hint counts where there are no positions to contradict it.
    CHECK(pixel_mm(scene.path, {"--focal-px", "80", "--mm-per-unit", "10"}) ==
          Approx(*middle * 10 / focal_px).epsilon(1e-3));
    PictureCopy(scene.path).without("ViewLayer.Position").write(folder / "told.exr");
    CHECK(pixel_mm(folder / "told.exr", {"--focal-px", "80", "--mm-per-unit", "10"}) == Approx(*middle * 10 / 80));

    // Positions say that pixels are not square: the finer axis counts.
    const double square = pixel_mm(scene.path, {"--mm-per-unit", "1"});
    std::vector<float> x = picture.plane("ViewLayer.Position.X");
    for (float& value : x) value *= 2;
    PictureCopy(scene.path).with("ViewLayer.Position.X", x).write(folder / "wide.exr");
    CHECK(pixel_mm(folder / "wide.exr", {"--mm-per-unit", "1"}) == Approx(square).epsilon(1e-3));
    for (float& value : x) value /= 4;
    PictureCopy(scene.path).with("ViewLayer.Position.X", x).write(folder / "narrow.exr");
    CHECK(pixel_mm(folder / "narrow.exr", {"--mm-per-unit", "1"}) == Approx(square / 2).epsilon(1e-3));
  }
}

TEST_CASE("the record in the result is a command that makes it again") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "step", 31, 20, 4);
  struct Case {
    Words words;
    std::string recorded;
  };
  const std::vector<Case> cases = {
      {{"--model", "guided", "--guide", "1.25", "--taps", "9", "--placement", "importance"},
       " --model guided --rank 1 --taps 9 --placement importance --guide 1.25"},
      {{"--model", "optimised", "--rank", "3", "--taps", "7", "--non-negative"},
       " --model optimised --rank 3 --taps 7 --placement optimised --non-negative"},
      {{"--tolerance", "0.03"}, " --method separable --tolerance 0.03 --shear off --jitter"},
      {{}, " --method separable --quality final --shear on --jitter"},
      {{"--quality", "draft", "--rank", "2"},
       " --method separable --quality draft --model optimised --rank 2 --placement optimised --shear off --jitter"},
      {{"--quality", "draft", "--shear", "on"}, " --method separable --quality draft --shear on --jitter"},
      {{"--taps", "9", "--shear", "off"}, " --placement optimised --shear off --jitter"},
      {{"--taps", "9", "--jitter", "0.5"}, " --placement optimised --shear off --jitter 0.5"},
      {{"--quality", "reference"}, " --method exact --albedo-mix"},
      {{"--method", "disc"}, " --method disc --samples auto --disc tangent --accumulate 1 --seed 0 --albedo-mix"},
      {{"--method", "disc", "--samples", "9", "--disc", "screen", "--prefilter", "--accumulate", "3", "--seed", "5"},
       " --method disc --samples 9 --disc screen --prefilter --accumulate 3 --seed 5 --albedo-mix"}};
  for (const Case& c : cases) {
    INFO(c.recorded);
    run_well(filter_arguments(scene, folder / "out.exr", with({"--material", "1=skin"}, c.words)));
    const std::string record = record_of(folder / "out.exr");
    INFO(record);
    CHECK(record.find(c.recorded) != std::string::npos);
    std::istringstream stream(record);
    Words again;
    for (std::string word; stream >> word;) again.push_back(word);
    REQUIRE(again.front() == "filter");
    run_well(with(again, {scene.path, "-o", folder / "again.exr"}));
    CHECK(is_identical(folder / "again.exr", folder / "out.exr"));
    CHECK(record_of(folder / "again.exr") == record);
  }
}
