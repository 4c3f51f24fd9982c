// dermis filter on small scenes: what is written, what is left alone, and that it is the same every time.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::exr::Picture;
using Words = std::vector<std::string>;

namespace {

const Words both_materials = {"--material", "1=burley:2/1/0.5", "--material", "2=wax"};

MadeScene random_touching(const TemporaryFolder& folder, Random& random) {
  return make_scene(folder / "in.exr", "touching", random.integer(20, 90), random.integer(20, 70),
                    random.uniform(2, 6));
}

std::set<std::string> names_of(const Picture& picture) {
  std::set<std::string> names;
  for (const auto& channel : picture.channels()) names.insert(channel.name);
  return names;
}

double largest(const std::vector<float>& values) {
  double most = 0;
  for (const float value : values) most = std::max(most, std::abs(static_cast<double>(value)));
  return most;
}

std::string attribute(const std::string& path, const std::string& name) {
  const auto input = OIIO::ImageInput::open(path);
  REQUIRE(input);
  return input->spec().get_string_attribute(name);
}

}  // namespace

TEST_CASE("filter adds the scattered light, recomposes the beauty and passes the rest through") {
  Random random(10);
  const TemporaryFolder folder;
  const MadeScene scene = random_touching(folder, random);
  const std::string output = folder / "out.exr";
  CHECK(run_well(filter_arguments(scene, output, both_materials)).empty());

  const Picture before = Picture::read(scene.path);
  const Picture after = Picture::read(output);
  std::set<std::string> expected = names_of(before);
  for (const char* c : {"R", "G", "B"}) expected.insert(std::string("ViewLayer.sss.") + c);
  CHECK(names_of(after) == expected);
  int changed = 0;
  for (const auto& channel : before.channels()) {
    INFO(channel.name);
    CHECK(after.find(channel.name)->format == channel.format);
    const bool same = bits_of(before, channel.name) == bits_of(after, channel.name);
    const bool beauty = channel.name.starts_with("ViewLayer.Combined");
    CHECK((same || beauty));
    changed += same ? 0 : 1;
  }
  CHECK(changed > 0);
  CHECK(after.find("ViewLayer.sss.R")->format == dermis::Format::f32);
  CHECK(largest(after.plane("ViewLayer.sss.R")) > 0.1);
  CHECK(after.plane("ViewLayer.sss.R") != before.plane("ViewLayer.DiffDir.R"));
}

TEST_CASE("--output-layers writes some channels of the whole result, with all attributes") {
  Random random(12);
  const TemporaryFolder folder;
  const MadeScene made = random_touching(folder, random);
  const Picture picture = Picture::read(made.path);
  const std::vector<float> alpha(static_cast<std::size_t>(picture.width()) * picture.height(), 0.5F);
  const MadeScene scene{folder / "alpha.exr", made.camera};
  PictureCopy(made.path).with("ViewLayer.Combined.A", alpha).attribute("note", "kept").write(scene.path);
  const auto filtered = [&](const std::string& layers) {
    Words more = both_materials;
    if (!layers.empty()) more.insert(more.end(), {"--output-layers", layers});
    run_well(filter_arguments(scene, folder / (layers + "out.exr"), more));
    return Picture::read(folder / (layers + "out.exr"));
  };
  const Picture whole = filtered("");
  const std::set<std::string> sss = {"ViewLayer.sss.R", "ViewLayer.sss.G", "ViewLayer.sss.B"};
  std::set<std::string> changed = sss;
  for (const char* c : {"R", "G", "B", "A"}) changed.insert(std::string("ViewLayer.Combined.") + c);
  const std::vector<std::pair<std::string, std::set<std::string>>> cases = {
      {"all", names_of(whole)}, {"changed", changed}, {"sss", sss}};
  for (const auto& [layers, names] : cases) {
    INFO(layers);
    const Picture some = filtered(layers);
    CHECK(names_of(some) == names);
    for (const auto& channel : some.channels()) CHECK(bits_of(some, channel.name) == bits_of(whole, channel.name));
    CHECK(attribute(folder / (layers + "out.exr"), "note") == "kept");
    CHECK(attribute(folder / (layers + "out.exr"), "dermis:command") ==
          attribute(folder / "out.exr", "dermis:command"));
  }
  check_refused(
      run_program(filter_arguments(scene, folder / "x.exr", {"--profile", "skin", "--output-layers", "beauty"})), 2,
      {"--output-layers: got beauty, want all or changed or sss"});
}

TEST_CASE("--output-layers changed needs no beauty") {
  const TemporaryFolder folder;
  const MadeScene made = make_scene(folder / "in.exr", "touching", 30, 20, 3);
  const MadeScene scene{folder / "without.exr", made.camera};
  PictureCopy(made.path).without("ViewLayer.Combined").write(scene.path);
  run_well(filter_arguments(scene, folder / "out.exr", {"--profile", "skin", "--output-layers", "changed"}));
  CHECK(names_of(Picture::read(folder / "out.exr")) ==
        std::set<std::string>{"ViewLayer.sss.R", "ViewLayer.sss.G", "ViewLayer.sss.B"});
}

TEST_CASE("pixels of other materials keep their bits") {
  Random random(11);
  const TemporaryFolder folder;
  const MadeScene scene = random_touching(folder, random);
  const std::string output = folder / "out.exr";
  const int id = random.integer(1, 2);
  run_well(filter_arguments(scene, output, {"--material", std::to_string(id) + "=burley:1/1/1"}));

  const Picture before = Picture::read(scene.path);
  const Picture after = Picture::read(output);
  const std::vector<float> ids = before.plane("ViewLayer.IndexMA.X");
  int others = 0;
  int others_changed = 0;
  int own_changed = 0;
  for (const char* c : {"R", "G", "B"}) {
    const auto old_bits = bits_of(before, std::string("ViewLayer.Combined.") + c);
    const auto new_bits = bits_of(after, std::string("ViewLayer.Combined.") + c);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const bool own = ids[i] == static_cast<float>(id);
      others += own ? 0 : 1;
      (own ? own_changed : others_changed) += old_bits[i] != new_bits[i] ? 1 : 0;
    }
  }
  CHECK(others > 0);
  CHECK(others_changed == 0);
  CHECK(own_changed > 0);
}

TEST_CASE("the same call gives the same bits: again, in place, and on any number of threads") {
  Random random(12);
  const TemporaryFolder folder;
  const MadeScene scene = random_touching(folder, random);
  Words options = both_materials;
  options.insert(options.end(), {"--jitter", "0.5", "--seed", std::to_string(random.integer(0, 1 << 30))});
  const std::string first = folder / "first.exr";
  run_well(filter_arguments(scene, first, options));

  run_well(filter_arguments(scene, folder / "again.exr", options));
  CHECK(is_identical(first, folder / "again.exr"));

  for (const char* threads : {"1", "2"}) {
    if (std::thread::hardware_concurrency() < 2 && *threads == '2') continue;
    INFO(threads << " threads");
    Words with_threads = options;
    with_threads.insert(with_threads.end(), {"--threads", threads});
    run_well(filter_arguments(scene, folder / "threads.exr", with_threads));
    CHECK(is_identical(first, folder / "threads.exr"));
  }

  Words other_seed = options;
  other_seed.back() = options.back() == "1" ? "2" : "1";
  run_well(filter_arguments(scene, folder / "other.exr", other_seed));
  CHECK_FALSE(is_identical(first, folder / "other.exr"));

  options.push_back("--in-place");
  run_well(filter_arguments(scene, scene.path, options));
  CHECK(is_identical(first, scene.path));
  for (const auto& file : fs::directory_iterator(folder.path()))
    CHECK(file.path().extension() == ".exr");  // no temporary file is left
}

TEST_CASE("a picture without a beauty gets the scattered light only") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "step", 40, 30, 4);
  PictureCopy(scene.path).without("ViewLayer.Combined").write(folder / "bare.exr");
  run_well(filter_arguments(scene, folder / "full.exr", {"--material", "1=skin"}));
  scene.path = folder / "bare.exr";
  run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin"}));
  const Picture out = Picture::read(folder / "out.exr");
  CHECK(out.find("ViewLayer.Combined.R") == nullptr);
  CHECK(bits_of(out, "ViewLayer.sss.R") == bits_of(Picture::read(folder / "full.exr"), "ViewLayer.sss.R"));
}

TEST_CASE("the camera found from position and depth is the one that was there") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 65, 47, 3);
  run_well(filter_arguments(scene, folder / "told.exr", {"--material", "1=skin"}));
  run_well({"filter", scene.path, "-o", folder / "found.exr", "--mm-per-unit", "1", "--material", "1=skin"});
  CHECK(relative_l2(folder / "found.exr", folder / "told.exr", "ViewLayer.sss") <= 1e-4);
}

TEST_CASE("positions alone, and depth alone, give the same picture") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 65, 47, 3);
  const Words material = {"--material", "1=skin"};
  run_well(filter_arguments(scene, folder / "both.exr", material));
  PictureCopy(scene.path).without("ViewLayer.Position").write(folder / "depth-in.exr");
  PictureCopy(scene.path).without("ViewLayer.Depth").write(folder / "position-in.exr");
  run_well(filter_arguments({folder / "depth-in.exr", scene.camera}, folder / "depth.exr", material));
  CHECK(relative_l2(folder / "depth.exr", folder / "both.exr", "ViewLayer.sss") == 0);
  run_well({"filter", folder / "position-in.exr", "-o", folder / "position.exr", "--mm-per-unit", "1", "--material",
            "1=skin"});
  // The camera that is found is right to 1e-4, and so is the size of the kernel; the light changes by less.
  CHECK(relative_l2(folder / "position.exr", folder / "both.exr", "ViewLayer.sss") <= 1e-4);
  CHECK(relative_l2(folder / "position.exr", folder / "position-in.exr", "ViewLayer.Combined") > 1e-3);
}

TEST_CASE("a Cryptomatte gives ids and mattes") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 61, 33, 4);
  const Picture picture = Picture::read(scene.path);
  const std::vector<float> ids = picture.plane("ViewLayer.IndexMA.X");
  const float left = dermis::exr::cryptomatte_id("Left half");
  const float right = dermis::exr::cryptomatte_id("Right.001");
  // Objects fill their pixels but for a column, where both show; what covers less comes second.
  std::vector<std::vector<float>> ranks(4, std::vector<float>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool is_left = ids[i] == 1;
    const bool is_shared = i % 61 == 20;
    ranks[0][i] = is_left ? left : right;
    ranks[1][i] = is_shared ? 0.7F : 1;
    ranks[2][i] = is_shared ? (is_left ? right : left) : 0;
    ranks[3][i] = is_shared ? 0.3F : 0;
  }
  PictureCopy with(scene.path);
  const Words channels = {"R", "G", "B", "A"};
  for (std::size_t k = 0; k < 4; ++k) with.with("ViewLayer.CryptoObject00." + channels[k], ranks[k]);
  with.without("ViewLayer.IndexMA").write(folder / "crypto-in.exr");
  std::vector<float> matte(ids.size(), 1);
  for (std::size_t i = 20; i < ids.size(); i += 61) matte[i] = 0.7F;
  PictureCopy(scene.path).with("edge.X", matte).write(folder / "ids-in.exr");

  Words by_id = both_materials;
  by_id.insert(by_id.end(), {"--role", "matte=edge"});
  run_well(filter_arguments({folder / "ids-in.exr", scene.camera}, folder / "ids.exr", by_id));
  Words by_name = both_materials;
  by_name.insert(by_name.end(), {"--cryptomatte", "Left half=1", "--cryptomatte", "Right.001=2"});
  run_well(filter_arguments({folder / "crypto-in.exr", scene.camera}, folder / "crypto.exr", by_name));
  const auto scattered = [&](const char* name) { return Picture::read(folder / name).plane("ViewLayer.sss.R"); };
  CHECK(scattered("crypto.exr") == scattered("ids.exr"));
  run_well(filter_arguments(scene, folder / "whole.exr", both_materials));
  CHECK(scattered("crypto.exr") != scattered("whole.exr"));
  CHECK(attribute(folder / "crypto.exr", "dermis:command").find("--cryptomatte") != std::string::npos);

  const auto refused = [&](const Words& more, int code, const std::vector<std::string>& parts) {
    Words words = both_materials;
    words.insert(words.end(), more.begin(), more.end());
    const MadeScene with_names = {folder / "crypto-in.exr", scene.camera};
    check_refused(run_program(filter_arguments(with_names, folder / "none.exr", words)), code, parts);
    CHECK_FALSE(std::filesystem::exists(folder / "none.exr"));
  };
  for (const char* malformed : {"Left half", "Left half=", "=1", "Left half=one", "Left half=65536"}) {
    refused({"--cryptomatte", malformed}, 2, {"--cryptomatte: got " + std::string(malformed), "NAME=ID"});
  }
  refused({"--cryptomatte", "Nobody=1"}, 5, {"Nobody", "covers no pixel"});
}

TEST_CASE("methods are drawn side by side") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 65, 47, 3);
  const std::string sheet = folder / "sheet.png";
  Words arguments = {"compare-methods", scene.path, "-o", sheet, "--material", "1=skin"};
  arguments.insert(arguments.end(), scene.camera.begin(), scene.camera.end());
  check_refused(run_program({"compare-methods", scene.path, "-o", sheet, "--material", "1=skin"}), 2,
                {"--mm-per-unit: got nothing"});
  Words lit = arguments;
  lit.insert(lit.end(), {"--lighting", "lit"});  // it has no such option: the rule of 2012 knows raw light only
  check_refused(run_program(lit), 2, {"--lighting"});
  check_refused(run_program(filter_arguments(scene, folder / "out.exr", {"--compare-methods", sheet})), 2,
                {"--compare-methods"});
  check_refused(run_program(arguments, {"PATH=" + (folder / "nosuch")}), 6, {"--output", "gnuplot"});
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) return;
  Words with_other_size = arguments;
  make_scene(folder / "small.exr", "sphere", 20, 20, 3);
  with_other_size.insert(with_other_size.end(), {"--truth", folder / "small.exr"});
  check_refused(run_program(with_other_size), 2, {"--truth: got 20x20 pixels", "65x47"});

  // The path tracer's place is taken by the scene itself.
  arguments.insert(arguments.end(), {"--truth", scene.path});
  run_well(arguments);
  const auto image = OIIO::ImageInput::open(sheet);
  REQUIRE(image);
  const OIIO::ImageSpec& spec = image->spec();
  std::vector<unsigned char> values(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  REQUIRE(image->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, values.data()));
  // Error maps are black but where they are not, and the first one has the most light in it.
  const auto light_in = [&](int column) {
    double sum = 0;
    const int panel = spec.width / 7;
    for (int y = spec.height * 2 / 3; y < spec.height * 9 / 10; ++y)
      for (int x = column * panel + panel / 4; x < column * panel + panel * 3 / 4; ++x)
        sum += values[(static_cast<std::size_t>(y) * spec.width + x) * spec.nchannels];
    return sum;
  };
  CHECK(light_in(0) > 2 * light_in(3));
  CHECK(light_in(3) > 0);
  CHECK(light_in(5) == 0);
}

TEST_CASE("an orthographic scene is filtered with pixels per unit") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 48, 20, 4, true);
  run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=burley:1/1/1"}));
  CHECK(relative_l2(folder / "out.exr", scene.path, "ViewLayer.Combined") > 1e-3);
}

TEST_CASE("the exact method and the separable one agree roughly, and more taps are no worse than few") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 61, 33, 4);
  const Words material = {"--material", "1=burley:1/0.7/0.5"};
  const auto run = [&](const std::string& name, Words more) {
    more.insert(more.end(), material.begin(), material.end());
    run_well(filter_arguments(scene, folder / name, more));
  };
  run("exact.exr", {"--method", "exact"});
  run("separable.exr", {"--taps", "25"});
  CHECK(relative_l2(folder / "separable.exr", folder / "exact.exr", "ViewLayer.sss") <= 0.05);
  CHECK_FALSE(is_identical(folder / "separable.exr", folder / "exact.exr"));
  run("few.exr", {"--taps", "3"});
  CHECK_FALSE(is_identical(folder / "separable.exr", folder / "few.exr"));
}

TEST_CASE("discs come near the exact method, report what they did, and depend on the seed") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", 61, 53, 4);
  const auto run = [&](const std::string& name, const Words& more) {
    Words words = {"--material", "1=burley:1/0.7/0.5"};
    words.insert(words.end(), more.begin(), more.end());
    return run_well(filter_arguments(scene, folder / name, words));
  };
  run("exact.exr", {"--method", "exact"});
  const std::string text = run("disc.exr", {"--method", "disc", "--samples", "200", "--prefilter", "--stats"});
  CHECK(relative_l2(folder / "disc.exr", folder / "exact.exr", "ViewLayer.sss") <= 0.01);
  CHECK(text.find("disc, 200 samples, tangent plane, prefiltered, accumulate 1, seed 0\n") != std::string::npos);
  const auto stats = nlohmann::json::parse(
      run("auto.exr", {"--method", "disc", "--disc", "screen", "--accumulate", "2", "--stats-json", "-"}));
  CHECK(stats["method"] == "disc");
  CHECK(stats["disc"] ==
        nlohmann::json::parse(R"({"samples": "auto", "plane": "screen", "prefiltered": false, "accumulate": 2})"));
  CHECK(stats["pixels"]["scattered"] > 500);
  CHECK(stats["pixels"]["unlit"] == 0);
  CHECK(stats["materials"][0]["design"].is_null());
  run("other.exr", {"--method", "disc", "--disc", "screen", "--accumulate", "2", "--seed", "9"});
  CHECK_FALSE(is_identical(folder / "other.exr", folder / "auto.exr"));
  CHECK(relative_l2(folder / "other.exr", folder / "auto.exr", "ViewLayer.sss") <= 0.05);
  // Both ways of texturing: the albedo after the discs, and half of it before.
  run("half.exr", {"--method", "disc", "--disc", "screen", "--accumulate", "2", "--albedo-mix", "0.5"});
  CHECK_FALSE(is_identical(folder / "half.exr", folder / "auto.exr"));
}

TEST_CASE("light with the albedo in it gives the same picture as light without") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 50, 41, 4);
  run_well(filter_arguments(scene, folder / "raw.exr", both_materials));

  const Picture picture = Picture::read(scene.path);
  PictureCopy lit(scene.path);
  for (const char* c : {"R", "G", "B"}) {
    std::vector<float> light = picture.plane(std::string("ViewLayer.DiffDir.") + c);
    const std::vector<float> albedo = picture.plane(std::string("ViewLayer.DiffCol.") + c);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] *= albedo[i];
    lit.with(std::string("ViewLayer.DiffDir.") + c, light);
  }
  lit.write(folder / "lit-in.exr");
  scene.path = folder / "lit-in.exr";
  Words options = both_materials;
  options.insert(options.end(), {"--lighting", "lit"});
  run_well(filter_arguments(scene, folder / "lit.exr", options));
  CHECK(relative_l2(folder / "lit.exr", folder / "raw.exr", "ViewLayer.Combined") <= 1e-5);
  CHECK(relative_l2(folder / "lit.exr", folder / "in.exr", "ViewLayer.Combined") > 1e-3);
}

TEST_CASE("the albedo mix changes where the albedo goes in") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "tilted", 50, 41, 4);
  run_well(filter_arguments(scene, folder / "after.exr", {"--material", "1=wax"}));
  run_well(filter_arguments(scene, folder / "half.exr", {"--material", "1=wax", "--albedo-mix", "0.5"}));
  CHECK(relative_l2(folder / "half.exr", folder / "after.exr", "ViewLayer.sss") > 1e-3);
}

TEST_CASE("a profile for every pixel, with and without a mask") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "step", 44, 26, 4);
  const Words profile = {"--profile", "burley:1/1/1"};
  run_well(filter_arguments(scene, folder / "all.exr", profile));
  CHECK(relative_l2(folder / "all.exr", scene.path, "ViewLayer.Combined") > 1e-3);

  std::vector<float> mask(44 * 26);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = i % 44 < 20 ? 0.0F : 1.0F;
  PictureCopy(scene.path).with("skin.V", mask).write(folder / "masked-in.exr");
  scene.path = folder / "masked-in.exr";
  Words with_mask = profile;
  with_mask.insert(with_mask.end(), {"--role", "mask=skin.V"});
  run_well(filter_arguments(scene, folder / "masked.exr", with_mask));
  const auto before = bits_of(Picture::read(scene.path), "ViewLayer.Combined.R");
  const auto after = bits_of(Picture::read(folder / "masked.exr"), "ViewLayer.Combined.R");
  int changed_outside = 0;
  int changed_inside = 0;
  for (std::size_t i = 0; i < mask.size(); ++i)
    (mask[i] > 0 ? changed_inside : changed_outside) += before[i] != after[i] ? 1 : 0;
  CHECK(changed_outside == 0);
  CHECK(changed_inside > 0);
}

TEST_CASE("profiles that are the same in other words give the same picture") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 44, 26, 4);
  const auto run = [&](const std::string& name, const std::string& profile) {
    run_well(filter_arguments(scene, folder / name, {"--material", "1=" + profile}));
  };
  SECTION("Cycles' radius: d = radius / (4 pi s(A)), s(.8) = 1.1") {
    run("d.exr", "burley:1/0.5/0.25");
    const double radius = 4 * 3.14159265358979323846 * 1.1;
    run("cycles.exr", "burley:" + std::to_string(radius) + "/" + std::to_string(radius / 2) + "/" +
                          std::to_string(radius / 4) + ",cycles,albedo=0.8/0.8/0.8");
    CHECK(relative_l2(folder / "cycles.exr", folder / "d.exr", "ViewLayer.sss") <= 1e-5);
    run("pixel.exr", "burley:12/6/3,cycles");
    CHECK(relative_l2(folder / "pixel.exr", scene.path, "ViewLayer.Combined") > 1e-3);
  }
  SECTION("one Gaussian, or two halves of it") {
    std::ofstream(folder / "one.json") << R"({"terms": [{"variance_mm2": 1, "weight": [1, 1, 1]}]})";
    std::ofstream(folder / "two.json") << R"({"terms": [{"variance_mm2": 1, "weight": [0.5, 1, 3]},
                                                        {"variance_mm2": 1, "weight": [0.5, 1, 3]}]})";
    run("one.exr", "gaussians:" + (folder / "one.json"));
    run("two.exr", "gaussians:" + (folder / "two.json"));
    CHECK(relative_l2(folder / "two.exr", folder / "one.exr", "ViewLayer.sss") <= 1e-6);
    CHECK(relative_l2(folder / "one.exr", scene.path, "ViewLayer.Combined") > 1e-3);
    CHECK(attribute(folder / "one.exr", "dermis:command").find(folder.path().string()) == std::string::npos);
  }
}

TEST_CASE("a material that no pixel has is a warning") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 20, 4);
  const Outcome outcome =
      run_program(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--material", "77=wax"}));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors == "dermis: warning: " + scene.path + ": --material 77: no pixel is of this material\n");
}

TEST_CASE("light that is not a number stays where it is, with a warning") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 31, 25, 4);
  std::vector<float> light = Picture::read(scene.path).plane("ViewLayer.DiffDir.G");
  light[12 * 31 + 20] = std::nanf("");
  PictureCopy(scene.path).with("ViewLayer.DiffDir.G", light).write(scene.path);
  const Outcome outcome = run_program(filter_arguments(scene, folder / "out.exr", both_materials));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors.find("light and albedo: 1 pixels are not finite") != std::string::npos);
  const Picture out = Picture::read(folder / "out.exr");
  const std::vector<float> green = out.plane("ViewLayer.Combined.G");
  CHECK(std::all_of(green.begin(), green.end(), [](float value) { return std::isfinite(value); }));
}

TEST_CASE("pixels that are not finite are kept, made black, or an error") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 31, 25, 4);
  const Picture before = Picture::read(scene.path);
  constexpr std::size_t at = 12 * 31 + 20;
  std::vector<float> light = before.plane("ViewLayer.DiffDir.G");
  light[at] = std::nanf("");
  PictureCopy(scene.path).with("ViewLayer.DiffDir.G", light).write(scene.path);
  const auto call = [&](const std::string& what) {
    Words words = both_materials;
    words.insert(words.end(), {"--bad-pixels", what});
    return filter_arguments(scene, folder / (what + ".exr"), words);
  };
  for (const std::string what : {"keep", "zero"}) {
    INFO(what);
    const Outcome outcome = run_program(call(what));
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors == "dermis: warning: " + scene.path + ": light and albedo: 1 pixels are not finite; they " +
                                std::string(what == "keep" ? "stay as they are" : "are black now") + "\n");
  }
  const Picture keep = Picture::read(folder / "keep.exr");
  const Picture zero = Picture::read(folder / "zero.exr");
  for (const char* c : {"R", "G", "B"}) {
    const std::string combined = std::string("ViewLayer.Combined.") + c;
    const std::vector<float> kept = keep.plane(combined);
    std::vector<float> zeroed = zero.plane(combined);
    REQUIRE(before.plane(combined)[at] > 0);
    CHECK(kept[at] == before.plane(combined)[at]);
    CHECK(zeroed[at] == 0);
    zeroed[at] = kept[at];
    CHECK(zeroed == kept);
  }
  check_refused(run_program(call("error")), 4,
                {"light: got 1 pixels that are not finite", "--bad-pixels keep or zero"});
  CHECK_FALSE(fs::exists(folder / "error.exr"));
}

TEST_CASE("attributes stay, and the result says how it was made") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "plain.exr", "step", 20, 16, 4);
  PictureCopy(scene.path)
      .attribute("Software", "some renderer 1.2")
      .attribute("Scene", "shot 12")
      .write(folder / "in.exr");
  scene.path = folder / "in.exr";
  run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--taps", "11"}));
  CHECK(attribute(folder / "out.exr", "Software") == "some renderer 1.2");
  CHECK(attribute(folder / "out.exr", "Scene") == "shot 12");
  CHECK_FALSE(attribute(folder / "out.exr", "dermis:version").empty());
  const std::string command = attribute(folder / "out.exr", "dermis:command");
  CHECK(command.starts_with("filter --material 1=skin"));
  CHECK(command.find("--taps 11") != std::string::npos);
  CHECK(command.find(folder.path().string()) == std::string::npos);
}

TEST_CASE("the compression is that of the input unless another is asked for") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  run_well(filter_arguments(scene, folder / "same.exr", {"--material", "1=skin"}));
  run_well(filter_arguments(scene, folder / "piz.exr", {"--material", "1=skin", "--compression", "piz"}));
  CHECK(Picture::read(folder / "same.exr").compression() == "zip");
  CHECK(Picture::read(folder / "piz.exr").compression() == "piz");
  CHECK(is_identical(folder / "same.exr", folder / "piz.exr"));
}

TEST_CASE("the preview is the beauty as a PNG of the same size") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 37, 23, 4);
  Words options = both_materials;
  options.insert(options.end(), {"--preview", folder / "p.png"});
  run_well(filter_arguments(scene, folder / "out.exr", options));
  const auto png = OIIO::ImageInput::open(folder / "p.png");
  REQUIRE(png);
  CHECK(png->format_name() == std::string("png"));
  CHECK(png->spec().width == 37);
  CHECK(png->spec().height == 23);
  REQUIRE(png->spec().nchannels == 3);
  std::vector<unsigned char> pixels(37 * 23 * 3);
  REQUIRE(png->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  const std::vector<float> red = Picture::read(folder / "out.exr").plane("ViewLayer.Combined.R");
  for (std::size_t i = 0; i < red.size(); ++i) {
    const double linear = std::clamp(static_cast<double>(red[i]), 0.0, 1.0);
    const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    REQUIRE(std::abs(pixels[i * 3] - 255 * srgb) <= 1);
  }
}

TEST_CASE("preview puts pictures side by side") {
  const TemporaryFolder folder;
  make_scene(folder / "a.exr", "step", 20, 16, 4);
  make_scene(folder / "b.exr", "touching", 13, 21, 4);
  run_well({"preview", folder / "a.exr", folder / "b.exr", "-o", folder / "sheet.png"});
  const auto png = OIIO::ImageInput::open(folder / "sheet.png");
  REQUIRE(png);
  CHECK(png->spec().width == 33);
  CHECK(png->spec().height == 21);
  std::vector<unsigned char> pixels(33 * 21 * 3);
  REQUIRE(png->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
  const std::vector<float> left = Picture::read(folder / "a.exr").plane("ViewLayer.Combined.G");
  const std::vector<float> right = Picture::read(folder / "b.exr").plane("ViewLayer.Combined.G");
  const auto level = [&](int x, int y) { return pixels[3 * (33 * y + x) + 1]; };
  // Brighter pixels stay brighter; below the lower picture there is nothing.
  CHECK((left[20 * 5 + 15] > left[20 * 5 + 2]) == (level(15, 5) > level(2, 5)));
  CHECK(level(20 + 3, 4) > 0);
  CHECK(right[13 * 4 + 3] > 0);
  CHECK(level(10, 18) == 0);
  check_refused(run_program({"preview", folder / "nothing.exr", "-o", folder / "x.png"}), 3, {"nothing.exr"});
}

TEST_CASE("the numbers of --stats-json add up") {
  Random random(13);
  const TemporaryFolder folder;
  const int width = random.integer(60, 150);
  const int height = random.integer(40, 100);
  const MadeScene scene = make_scene(folder / "in.exr", "sphere", width, height, 3);
  Words options = {"--material", "1=skin", "--stats-json", folder / "stats.json"};
  CHECK(run_well(filter_arguments(scene, folder / "out.exr", options)).empty());
  std::ifstream file(folder / "stats.json");
  const auto stats = nlohmann::json::parse(file);

  const auto& blocks = stats["blocks"];
  int blocks_of_kinds = 0;
  for (const char* kind : {"without_material", "narrow", "unlit", "uniform", "flat", "curved", "reused", "mixed"}) {
    blocks_of_kinds += blocks[kind].get<int>();
  }
  CHECK(blocks["total"] == blocks_of_kinds);
  CHECK(blocks["total"] == (width + 15) / 16 * ((height + 15) / 16));
  for (const auto& [kind, count] : blocks.items()) CHECK_FALSE(kind.empty());
  CHECK(blocks["flat"].get<int>() + blocks["curved"].get<int>() + blocks["mixed"].get<int>() > 0);
  const auto& pixels = stats["pixels"];
  CHECK(pixels["total"] == width * height);
  CHECK(pixels["total"].get<int>() ==
        pixels["scattered"].get<int>() + pixels["without_material"].get<int>() + pixels["narrow"].get<int>());
  const std::vector<float> ids = Picture::read(scene.path).plane("ViewLayer.IndexMA.X");
  const auto of_material = std::count(ids.begin(), ids.end(), 1.0F);
  CHECK(pixels["scattered"] == of_material);
  REQUIRE(stats["materials"].size() == 1);
  CHECK(stats["materials"][0]["id"] == 1);
  CHECK(stats["materials"][0]["profile"] == "skin");
  CHECK(stats["materials"][0]["pixels"] == of_material);
  CHECK(stats["materials"][0]["radius_mm"] > 1.0);

  const auto& times = stats["times_ms"];
  for (const char* step : {"read", "plan", "prepare", "classify", "scatter", "finish", "run", "write", "total"}) {
    INFO(step);
    CHECK(times[step] >= 0.0);
  }
  CHECK(times["total"].get<double>() >= times["read"].get<double>() + times["plan"].get<double>() +
                                            times["run"].get<double>() + times["write"].get<double>() - 1e-6);
  CHECK(stats["method"] == "separable");
  CHECK(stats["quality"] == "final");
  CHECK(stats["tolerance"] == 0.006);
  CHECK(stats["materials"][0]["design"]["predicted_rel_l2"] <= 0.006);
  CHECK(stats["camera"]["source"] == "position and depth");
  CHECK(stats["roles"]["layer"] == "ViewLayer");
  CHECK(stats["roles"]["mask"].is_null());
  CHECK_FALSE(stats["device"]["name"].get<std::string>().empty());
}

TEST_CASE("statistics on stdout, as a table or as JSON") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const std::string table = run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--stats"}));
  for (const char* word :
       {"device", "camera", "rank", " taps", "predicted error", "blocks", "pixels", "scattered", "narrow", "total"})
    CHECK(table.find(word) != std::string::npos);
  const std::string text =
      run_well(filter_arguments(scene, folder / "out.exr", {"--profile", "skin", "--stats-json", "-"}));
  const auto stats = nlohmann::json::parse(text);
  CHECK(stats["materials"][0]["id"].is_null());
  CHECK(stats["materials"][0]["pixels"] == 320);
}

TEST_CASE("the result goes to the layer that was asked for, or to no layer") {
  const TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "step", 20, 16, 4);
  const std::string plain = scene.path;
  SECTION("two layers") {
    PictureCopy(plain).with_layer("Second.").write(folder / "two.exr");
    scene.path = folder / "two.exr";
    run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin", "--layer", "Second"}));
    const Picture before = Picture::read(scene.path);
    const Picture after = Picture::read(folder / "out.exr");
    CHECK(after.find("Second.sss.R") != nullptr);
    CHECK(after.find("ViewLayer.sss.R") == nullptr);
    CHECK(bits_of(after, "ViewLayer.Combined.R") == bits_of(before, "ViewLayer.Combined.R"));
    CHECK(bits_of(after, "Second.Combined.R") != bits_of(before, "Second.Combined.R"));
  }
  SECTION("no layer") {
    PictureCopy(plain).with_layer("").without("ViewLayer.").write(folder / "none.exr");
    scene.path = folder / "none.exr";
    run_well(filter_arguments(scene, folder / "out.exr", {"--material", "1=skin"}));
    CHECK(Picture::read(folder / "out.exr").find("sss.R") != nullptr);
  }
}
