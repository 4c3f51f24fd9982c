// Every call that must fail: its exit code, its message, and that nothing is written.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

/// A good call of `dermis filter` on a small scene, to be spoiled.
class GoodCall {
 public:
  GoodCall() : scene_(make_scene(folder_ / "in.exr", "sphere", 33, 21, 2)) {}

  const TemporaryFolder& folder() const { return folder_; }
  const std::string& input() const { return scene_.path; }
  std::string output() const { return folder_ / "out.exr"; }

  /// The good call with other arguments at the end; `skip` leaves an option of two words out.
  Words with(const Words& more, const std::string& skip = {}) const {
    Words arguments = {"filter", input(), "-o", output(), "--mm-per-unit", "1", "--material", "1=skin"};
    if (const auto at = std::find(arguments.begin(), arguments.end(), skip); at != arguments.end())
      arguments.erase(at, at + 2);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  void check_refuses(const Words& more, int code, const Words& parts, const std::string& skip = {}) const {
    check_refused(run_program(with(more, skip)), code, parts);
    CHECK_FALSE(fs::exists(output()));
  }

  /// Checks that the call on another input is refused.
  void check_refuses_input(const std::string& path, int code, const Words& parts, const Words& more = {}) const {
    Words arguments = with(more);
    arguments[1] = path;
    check_refused(run_program(arguments), code, parts);
    CHECK_FALSE(fs::exists(output()));
  }

 private:
  TemporaryFolder folder_;
  MadeScene scene_;
};

void write_file(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("a call without a command or with an unknown one is a usage error") {
  check_refused(run_program({}), 2, {"subcommand"});
  check_refused(run_program({"blur"}), 2, {"command: got blur", "filter, texture"});
  check_refused(run_program({"filter"}), 2, {"file"});
  check_refused(run_program({"devices", "--nosuch"}), 2, {"--nosuch"});
}

TEST_CASE("values outside their ranges are usage errors that name argument, value and range") {
  const GoodCall call;
  struct Case {
    std::string option;
    std::string value;
    std::string wanted;
  };
  const std::vector<Case> cases = {{"--taps", "4", "odd number from 3 to 2047 or dense"},
                                   {"--taps", "2049", "odd number from 3 to 2047 or dense"},
                                   {"--taps", "x", "odd number from 3 to 2047 or dense"},
                                   {"--taps", "", "odd number from 3 to 2047 or dense"},
                                   {"--jitter", "2", "0 to 1"},
                                   {"--shear", "maybe", "auto or on or off"},
                                   {"--seed", "4294967296", "4294967295"},
                                   {"--rank", "0", "1 to 6"},
                                   {"--rank", "7", "1 to 6"},
                                   {"--model", "burley", "pre-integrated or artist"},
                                   {"--placement", "random", "uniform or importance"},
                                   {"--guide", "4.1", "0 to 4"},
                                   {"--tolerance", "0", "between 0 and 1"},
                                   {"--tolerance", "1", "between 0 and 1"},
                                   {"--tolerance", "-0.1", "between 0 and 1"},
                                   {"--tolerance", "nan", "between 0 and 1"},
                                   {"--method", "fast", "separable or exact or disc"},
                                   {"--samples", "0", "1 to 1024 or auto"},
                                   {"--samples", "1025", "1 to 1024 or auto"},
                                   {"--samples", "some", "1 to 1024 or auto"},
                                   {"--disc", "flat", "tangent or screen"},
                                   {"--accumulate", "0", "1 to 65536"},
                                   {"--lighting", "dark", "auto or raw or lit"},
                                   {"--albedo-mix", "-0.1", "0 to 1"},
                                   {"--fov", "nan", "below 180"},
                                   {"--focal-px", "inf", "> 0"},
                                   {"--px-per-unit", "-3", "> 0"},
                                   {"--threads", "0", "> 0"},
                                   {"--device-memory", "-1", "0..1000000"},
                                   {"--compression", "gzip", "piz"},
                                   {"--quality", "best", "draft or preview or final or reference"},
                                   {"--rank", "any", "or auto"},
                                   {"--bad-pixels", "fix", "keep or zero or error"},
                                   {"--tile-map", "out.jpg", ".png"},
                                   {"--preview", "out.jpg", ".png"}};
  for (const Case& c : cases) {
    INFO(c.option << " " << c.value);
    call.check_refuses({c.option, c.value}, 2,
                       {c.option + ": got " + (c.value.empty() ? "nothing" : c.value), c.wanted});
  }
}

TEST_CASE("a design that the model does not know is a usage error that names the option") {
  const GoodCall call;
  struct Case {
    Words words;
    Words parts;
  };
  const std::vector<Case> cases = {
      {{"--model", "optimised", "--rank", "4"}, {"--rank: got 4", "1..3"}},
      {{"--model", "artist", "--rank", "2"}, {"--rank: got 2", "1 for this model"}},
      {{"--model", "guided", "--rank", "3"}, {"--rank: got 3", "1 for this model"}},
      {{"--model", "pre-integrated", "--rank", "2"}, {"--rank: got 2", "1 for this model"}},
      {{"--model", "svd", "--guide", "1"}, {"--guide: got 1 for --model svd", "--model guided"}},
      {{"--model", "optimised", "--rank", "1", "--non-negative"}, {"--non-negative: got", "--rank 1", "--rank 2 or 3"}},
      {{"--model", "svd", "--rank", "2", "--non-negative"}, {"--non-negative: got --model svd", "--model optimised"}}};
  for (const Case& c : cases) {
    INFO(c.parts.front());
    call.check_refuses(c.words, 2, c.parts);
  }
}

TEST_CASE("options of another method are a usage error that names both") {
  const GoodCall call;
  struct Case {
    Words words;
    Words parts;
  };
  const std::vector<Case> cases = {
      {{"--samples", "9"}, {"--samples: got 9 with --method separable", "--method disc"}},
      {{"--disc", "screen", "--method", "exact"}, {"--disc: got screen with --method exact", "--method disc"}},
      {{"--prefilter"}, {"--prefilter: got it with --method separable", "--method disc"}},
      {{"--accumulate", "2", "--quality", "reference"}, {"--accumulate: got 2 with --method exact", "--method disc"}},
      {{"--method", "disc", "--taps", "9"}, {"--taps: got 9 with --method disc", "--method separable"}},
      {{"--method", "disc", "--rank", "2"}, {"--rank: got 2 with --method disc", "--method separable"}},
      {{"--method", "disc", "--non-negative"}, {"--non-negative: got it with --method disc", "--method separable"}},
      {{"--method", "disc", "--quality", "draft"}, {"--quality: got draft with --method disc", "--samples"}},
      {{"--method", "disc", "--quality", "reference"}, {"--quality: got reference with --method disc", "--samples"}},
      {{"--method", "disc", "--tolerance", "0.1"}, {"--tolerance: got 0.1 with --method disc", "--samples"}},
      {{"--method", "disc", "--jitter", "0.5"}, {"--jitter: got 0.5 with --method disc", "--method separable"}},
      {{"--method", "disc", "--shear", "on"}, {"--shear: got on with --method disc", "--method separable"}},
      {{"--method", "disc", "--tile-map", call.folder() / "t.png"}, {"--tile-map: got", "with --method disc"}}};
  for (const Case& c : cases) {
    INFO(c.parts.front());
    call.check_refuses(c.words, 2, c.parts);
  }
}

TEST_CASE("what contradicts a quality is a usage error that names both") {
  const GoodCall call;
  struct Case {
    Words words;
    Words parts;
  };
  const std::vector<Case> cases = {
      {{"--tolerance", "0.05", "--taps", "9"}, {"--taps: got 9 with --tolerance 0.05", "want auto"}},
      {{"--taps", "dense", "--tolerance", "0.05"}, {"--taps: got dense with --tolerance 0.05", "want auto"}},
      {{"--quality", "draft", "--taps", "9"}, {"--taps: got 9 with --quality draft", "want auto"}},
      {{"--rank", "auto", "--taps", "9"}, {"--taps: got 9 with --rank auto", "want auto"}},
      {{"--quality", "draft", "--tolerance", "0.05"}, {"--quality: got draft with --tolerance 0.05", "one of the two"}},
      {{"--quality", "draft", "--method", "exact"}, {"--quality: got draft with --method exact", "want reference"}},
      {{"--tolerance", "0.05", "--method", "exact"}, {"--tolerance: got 0.05 with --method exact"}},
      {{"--quality", "reference", "--method", "separable"}, {"--quality: got reference with --method separable"}},
      {{"--quality", "reference", "--taps", "9"}, {"--quality: got reference with --taps 9"}},
      {{"--quality", "reference", "--rank", "auto"}, {"--quality: got reference with --rank auto"}},
      {{"--tolerance", "0.05", "--guide", "1"}, {"--guide: got 1 for --model optimised", "--model guided"}},
      {{"--tolerance", "0.05", "--rank", "4"}, {"--rank: got 4", "1..3"}},
      {{"--method", "exact", "--tile-map", call.folder() / "t.png"}, {"--tile-map: got", "the exact method"}},
      {{"--quality", "reference", "--tile-map", call.folder() / "t.png"}, {"--tile-map: got", "the exact method"}}};
  for (const Case& c : cases) {
    INFO(c.parts.front());
    call.check_refuses(c.words, 2, c.parts);
    CHECK_FALSE(fs::exists(call.folder() / "t.png"));
  }
}

TEST_CASE("the scale has no default and must be a finite number above 0") {
  const GoodCall call;
  call.check_refuses({}, 2, {"--mm-per-unit: got nothing", "millimetres per scene unit"}, "--mm-per-unit");
  for (const std::string value : {"0", "nan", "ten"})
    call.check_refuses({"--mm-per-unit", value}, 2, {"--mm-per-unit: got " + value, "> 0"}, "--mm-per-unit");
}

TEST_CASE("no output takes the place of another one or of the input") {
  const GoodCall call;
  const std::string before = read_file(call.input());
  call.check_refuses({"--stats-json", call.input()}, 2, {"--stats-json: got", "not the input as well"});
  call.check_refuses({"--stats-json", call.output()}, 2, {"--stats-json: got", "not --output as well"});
  const std::string picture = call.folder() / "p.png";
  call.check_refuses({"--preview", picture, "--stats-json", call.folder() / "./p.png"}, 2, {"not --preview as well"});
  CHECK(read_file(call.input()) == before);
  CHECK_FALSE(fs::exists(picture));

  // two names of a file that is not there yet, in the folder that the program runs in
  const Surroundings there = {.folder = call.folder().path().string()};
  const auto check = [&](const std::string& output, const std::string& stats) {
    Words arguments = call.with({"-o", output, "--stats-json", stats}, "-o");
    check_refused(run_program(arguments, there), 2, {"--stats-json: got " + stats, "not --output as well"});
  };
  check("new.exr", "./new.exr");
  check("./new.exr", "new.exr");
  check("new.exr", call.folder() / "new.exr");
  CHECK_FALSE(fs::exists(call.folder() / "new.exr"));
}

TEST_CASE("options that contradict each other are usage errors") {
  const GoodCall call;
  call.check_refuses({"--profile", "skin"}, 2, {"--material", "--profile"});
  call.check_refuses({"--fov", "40", "--focal-px", "100"}, 2, {"--fov", "--focal-px"});
  call.check_refuses({"--stats", "--stats-json", "-"}, 2, {"--stats-json"});
  call.check_refuses({"--tile-map", call.folder() / "t.png", "--stats-json", "-"}, 2, {"--stats-json", "--tile-map"});
  call.check_refuses({}, 2, {"--material", "--profile"}, "--material");
  call.check_refuses({"--material", "1=wax"}, 2, {"--material: got 1=wax", "once"});
  call.check_refuses({"--shear", "on", "--jitter", "0.5"}, 2, {"--shear: got on with --jitter 0.5", "off or auto"});
}

TEST_CASE("a malformed profile is a usage error that says what a profile is") {
  const GoodCall call;
  struct Case {
    std::string text;
    Words parts;
  };
  const std::vector<Case> cases = {{"skin", {"got skin", "ID=PROFILE"}},
                                   {"65536=skin", {"got 65536=skin", "0 to 65535"}},
                                   {"1=", {"--material 1: got nothing", "skin", "marble"}},
                                   {"1=leather", {"--material 1: got leather", "skin", "marble", "milk", "wax"}},
                                   {"1=burley:1/2", {"got burley:1/2", "three lengths"}},
                                   {"1=burley:1/0/3", {"got burley:1/0/3", "> 0"}},
                                   {"1=burley:1/nan/3", {"got burley:1/nan/3", "> 0"}},
                                   {"1=burley:1/2/3,arnold", {"got burley:1/2/3,arnold", "cycles"}},
                                   {"1=burley:1/2/3,cycles,x=1", {"x=1", "albedo="}},
                                   {"1=burley:1/2/3,cycles,albedo=1/2/1", {"albedo=1/2/1", "0 to 1"}},
                                   {"1=burley:1/2/3,cycles,albedo=.1/.2/.1,more", {"more", "cycles"}}};
  for (const Case& c : cases) {
    INFO(c.text);
    call.check_refuses({"--material", c.text}, 2, c.parts, "--material");
  }
  call.check_refuses({"--profile", "leather"}, 2, {"--profile: got leather", "skin"}, "--material");
}

TEST_CASE("a file of Gaussians that is missing or malformed is an input error that names the place") {
  const GoodCall call;
  const std::string file = call.folder() / "terms.json";
  const Words material = {"--material", "1=gaussians:" + file};
  call.check_refuses(material, 3, {"--material 1: got " + file, "JSON"}, "--material");
  call.check_refuses({"--material", "1=gaussians:"}, 3, {"no file name"}, "--material");

  struct Case {
    std::string text;
    Words parts;
  };
  const std::vector<Case> cases = {
      {"{", {"parse error", "want JSON"}},
      {R"({"terms": []})", {"no list of terms"}},
      {R"({"terms": [7]})", {"terms[0] = 7", "variance_mm2 and weight"}},
      {R"({"terms": [{"variance_mm2": 0, "weight": [1, 1, 1]}]})", {"terms[0].variance_mm2 = 0", "> 0"}},
      {R"({"terms": [{"variance_mm2": "1", "weight": [1, 1, 1]}]})", {R"(terms[0].variance_mm2 = "1")"}},
      {R"({"terms": [{"variance_mm2": 1, "weight": [1, 1]}]})", {"terms[0].weight = [1,1]", "three"}},
      {R"({"terms": [{"variance_mm2": 1, "weight": [1, -1, 1]}]})", {"terms[0].weight[1] = -1", ">= 0"}},
      {R"({"terms": [{"variance_mm2": 1, "weight": [1, 0, 1]}]})", {"channel 1", "every channel"}}};
  for (const Case& c : cases) {
    INFO(c.text);
    write_file(file, c.text);
    Words parts = c.parts;
    parts.push_back(file);
    call.check_refuses(material, 4, parts, "--material");
  }
}

TEST_CASE("an input that is not there, is not EXR or is damaged") {
  const GoodCall call;
  const std::string other = call.folder() / "other.exr";
  call.check_refuses_input(other, 3, {other});
  write_file(other, "this is no picture");
  call.check_refuses_input(other, 4, {other});
  write_file(other, "");
  call.check_refuses_input(other, 4, {other});
  call.check_refuses_input(call.folder().path().string(), 4, {call.folder().path().string()});

  Random random(1);
  const std::string whole = read_file(call.input());
  for (int i = 0; i < 4; ++i) {
    const int length = random.integer(4, static_cast<int>(whole.size()) - 1);
    INFO("truncated to " << length << " of " << whole.size() << " bytes");
    write_file(other, whole.substr(0, static_cast<std::size_t>(length)));
    call.check_refuses_input(other, 4, {other});
  }
}

TEST_CASE("a role that is missing is an error that names it and lists the channels") {
  const GoodCall call;
  const std::string spoiled = call.folder() / "spoiled.exr";
  const auto check = [&](const std::string& pass, const std::string& role, const Words& more) {
    INFO(role);
    PictureCopy(call.input()).without("ViewLayer." + pass).write(spoiled);
    call.check_refuses_input(spoiled, 5, {role, "ViewLayer.Normal.{X,Y,Z}"}, more);
  };
  check("DiffDir", "light", {});
  check("DiffCol", "albedo", {});
  check("IndexMA", "material", {});
  check("Combined", "beauty", {"--preview", call.folder() / "p.png"});
  PictureCopy(call.input()).without("ViewLayer.Depth").without("ViewLayer.Position").write(spoiled);
  call.check_refuses_input(spoiled, 5, {"depth", "ViewLayer.Normal.{X,Y,Z}"}, {"--focal-px", "100"});
  call.check_refuses({"--role", "light=Nosuch"}, 5, {"Nosuch", "ViewLayer.DiffDir.{R,G,B}"});
  call.check_refuses({"--role", "light"}, 2, {"light"});
  call.check_refuses({"--role", "colour=ViewLayer.DiffDir"}, 2, {"colour"});
}

TEST_CASE("a camera that cannot be known is an error, never a guess") {
  const GoodCall call;
  const std::string spoiled = call.folder() / "spoiled.exr";
  PictureCopy(call.input()).without("ViewLayer.Position").write(spoiled);
  call.check_refuses_input(spoiled, 5, {"camera"});

  // all positions at one point, or not numbers: no camera fits
  const std::size_t pixels = 33 * 21;
  for (const float value : {1.0F, std::nanf("")}) {
    PictureCopy copy(call.input());
    for (const char* axis : {"X", "Y", "Z"})
      copy.with(std::string("ViewLayer.Position.") + axis, std::vector<float>(pixels, value));
    copy.write(spoiled);
    call.check_refuses_input(spoiled, 5, {"camera"});
  }
}

TEST_CASE("an output that cannot be written is an error before the work") {
  const GoodCall call;
  const std::string in_file = call.input() + "/out.exr";
  const auto check = [&](const std::string& output, const std::string& wanted) {
    INFO(output);
    call.check_refuses({"-o", output}, 6, {"--output: got " + output, wanted}, "-o");
  };
  check(call.folder() / "nosuch/out.exr", "folder that exists");
  check(in_file, "folder that exists");
  const std::string folder = call.folder() / "folder.exr";
  fs::create_directory(folder);
  check(folder, "not of a folder");
  call.check_refuses({"-o", call.folder() / "out.tiff"}, 2, {"--output", "out.tiff", ".exr"}, "-o");
  call.check_refuses({"--tile-map", call.folder() / "nosuch/t.png"}, 6, {"--tile-map", "nosuch/t.png"});
  call.check_refuses({"--preview", call.folder() / "nosuch/p.png"}, 6, {"--preview", "nosuch/p.png"});
  call.check_refuses({"--stats-json", call.folder() / "nosuch/s.json"}, 6, {"--stats-json", "nosuch/s.json"});
  // a folder in which nobody can make files, not even root
  check_refused(run_program(call.with({"-o", "/proc/out.exr"}, "-o")), 6, {"/proc/out.exr"});
}

TEST_CASE("a device that is not there is an error") {
  const GoodCall call;
  call.check_refuses({"--device", "nosuch"}, 7, {"nosuch"});
  call.check_refuses({"--device", "99"}, 7, {"99"});
  call.check_refuses({"--threads", "100000"}, 2, {"threads", "100000"});
  const Surroundings no_driver = {.environment = "OCL_ICD_VENDORS=" + (call.folder() / "nosuch")};
  check_refused(run_program(call.with({}), no_driver), 7, {});
  check_refused(run_program({"devices"}, no_driver), 7, {"devices: got none", "OpenCL"});
}

TEST_CASE("bad calls of the other commands") {
  const TemporaryFolder folder;
  check_refused(run_program({"info", folder / "nosuch.exr"}), 3, {"nosuch.exr"});
  check_refused(run_program({"info"}), 2, {"file"});
  check_refused(run_program({"compare", folder / "a.exr", folder / "b.exr"}), 3, {"a.exr"});
  check_refused(run_program({"compare", folder / "a.exr"}), 2, {"b"});
  check_refused(run_program({"scene", "teapot", "-o", folder / "out.exr"}), 2, {"teapot", "impulse", "touching"});
  check_refused(run_program({"scene", "step", "-o", folder / "out.exr", "--size", "12"}), 2, {"--size: got 12"});
  check_refused(run_program({"scene", "step", "-o", folder / "out.exr", "--size", "0x4"}), 2, {"--size: got 0x4"});
  check_refused(run_program({"scene", "step", "-o", folder / "out.exr", "--px-per-mm", "0"}), 2,
                {"--px-per-mm: got 0"});
  check_refused(run_program({"scene", "step", "-o", folder / "nosuch/out.exr"}), 6, {"nosuch/out.exr"});
  check_refused(run_program({"profiles", "--plot", folder / "plot.pdf"}), 2, {"--plot: got", ".svg or .png"});
  check_refused(run_program({"profiles", "--plot", folder / "nosuch/plot.svg"}), 6, {"--plot"});
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("names from outside cannot break the line or steer the terminal") {
  const Outcome outcome = run_program({"info", "/nosuch/\x1b[31m\nred.exr"});
  check_refused(outcome, 3, {"red.exr"});
  CHECK(outcome.errors.find('\x1b') == std::string::npos);
}
