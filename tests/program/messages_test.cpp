// Notes, warnings and errors: where they are said, and what --strict and --quiet make of them.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arguments/device_arguments.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

namespace {

/// A scene with a pass "sss" of the renderer's, which a note is about; the warning is about a material.
struct Talkative {
  TemporaryFolder folder;
  MadeScene scene = make_scene(folder / "in.exr", "touching", 40, 30, 3);

  Talkative() {
    PictureCopy(scene.path).with("ViewLayer.sss.R", std::vector<float>(std::size_t{40} * 30, 0.5F)).write(scene.path);
  }

  Outcome filter(const Words& more) const {
    Words arguments = {"--material", "1=wax", "--material", "77=wax", "--stats-json", folder / "stats.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(filter_arguments(scene, folder / "out.exr", arguments));
  }

  std::string note() const { return "ViewLayer.sss: this pass is the renderer's; ours is ViewLayer.sss_dermis"; }
  std::string warning() const { return "--material 77: no pixel is of this material"; }
};

}  // namespace

TEST_CASE("notes and warnings are one line each, in --stats-json too") {
  const Talkative call;
  const Outcome outcome = call.filter({});
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.errors ==
        "dermis: warning: " + call.scene.path + ": " + call.warning() + "\ndermis: note: " + call.note() + "\n");
  std::ifstream file(call.folder / "stats.json");
  const auto stats = nlohmann::json::parse(file);
  CHECK(stats["notes"] == Words{call.note()});
  CHECK(stats["warnings"][0] == call.warning());
  CHECK(stats["input"].size() >= 3);
}

TEST_CASE("--quiet leaves the warnings, --strict makes them errors before anything is written") {
  const Talkative call;
  CHECK(call.filter({"--quiet"}).errors == "dermis: warning: " + call.scene.path + ": " + call.warning() + "\n");
  fs::remove(call.folder / "out.exr");
  fs::remove(call.folder / "stats.json");
  const Outcome strict = call.filter({"--strict", "--quiet"});
  check_refused(strict, 5, {call.scene.path + ": --material 77: got no pixel is of this material", "--strict"});
  CHECK_FALSE(fs::exists(call.folder / "out.exr"));
  CHECK_FALSE(fs::exists(call.folder / "stats.json"));
}

TEST_CASE("a cache that PoCL cannot write is named") {
  const Talkative call;
  const Surroundings surroundings = {.environment = "POCL_CACHE_DIR=/proc/nosuch"};
  check_refused(run_program({"devices"}, surroundings), 7, {"/proc/nosuch", "POCL_CACHE_DIR"});
  check_refused(run_program(filter_arguments(call.scene, call.folder / "out.exr", {"--material", "1=wax", "--quiet"}),
                            surroundings),
                7, {"/proc/nosuch", "POCL_CACHE_DIR"});
}

TEST_CASE("a full cache is an error of the device that names it, never 1") {
  const TemporaryFolder folder;
  const MadeScene scene = make_scene(folder / "in.exr", "touching", 40, 30, 3);
  fs::create_directory(folder / "cache");
  std::string command = "ulimit -f 2; POCL_CACHE_DIR='" + (folder / "cache") + "' '" + DERMIS_PROGRAM + "'";
  for (const std::string& word : filter_arguments(scene, folder / "out.exr", {"--material", "1=wax"}))
    command += " '" + word + "'";
  const int status = std::system((command + " 2>'" + (folder / "errors") + "'").c_str());
  const std::string errors = bytes_of_file(folder / "errors");
  INFO(errors);
  CHECK(WEXITSTATUS(status) == 7);
  CHECK(has(errors, "PoCL's cache " + (folder / "cache") + " cannot be written (File too large)"));
  CHECK_FALSE(fs::exists(folder / "out.exr"));
}

TEST_CASE("--device takes the kind that devices prints") {
  const Talkative call;
  const std::string devices = run_well({"devices"});
  for (const std::string kind : {"CPU", "GPU"}) {
    if (!has(devices, ": " + kind + ",")) continue;
    INFO(kind);
    CHECK(call.filter({"--device", kind}).exit_code == 0);
  }
  check_refused(run_program(filter_arguments(call.scene, call.folder / "x.exr",
                                             {"--material", "1=wax", "--quiet", "--device", "FPGA"})),
                7, {"FPGA"});
}

TEST_CASE("a device that was chosen is named, and one that cannot reuse frames says so") {
  dermis::DeviceInfo gpu;
  gpu.name = "Quick 9000";
  gpu.type = "GPU";
  dermis::DeviceInfo cpu;
  cpu.name = "Old 1";
  cpu.type = "CPU";
  using dermis::program::device_notes;
  using Notes = std::vector<std::string>;
  CHECK(device_notes(true, gpu, 3, false).empty());
  CHECK(device_notes(false, cpu, 1, true).empty());
  CHECK(device_notes(false, gpu, 3, false) == Notes{"device: Quick 9000, the first GPU of 3 devices (--device)"});
  CHECK(device_notes(false, cpu, 2, true) == Notes{"device: Old 1, the first one of 2 devices (--device)"});
  CHECK(device_notes(true, gpu, 1, true) ==
        Notes{"--reuse: does nothing on Quick 9000, for a GPU filters all of every frame"});
}

TEST_CASE("devices --test compares each with the oracle") {
  const std::string listed = run_well({"devices"});
  const std::string tested = run_well({"devices", "--test"});
  CHECK(std::count(tested.begin(), tested.end(), '\n') == std::count(listed.begin(), listed.end(), '\n'));
  CHECK(has(tested, "0  " + listed.substr(3, listed.find(": ") - 3) + ": right: separable 0."));
}

TEST_CASE("a pixelAspectRatio that no picture can have is named") {
  const TemporaryFolder folder;
  make_scene(folder / "in.exr", "step", 8, 8, 4);
  const std::string bytes = bytes_of_file(folder / "in.exr");
  const std::string name("pixelAspectRatio\0float\0", 23);
  const std::size_t at = bytes.find(name) + name.size() + 4;
  for (const float ratio : {std::numeric_limits<float>::quiet_NaN(), 0.0F, -1.0F, 1e30F}) {
    std::string spoiled = bytes;
    std::memcpy(spoiled.data() + at, &ratio, sizeof ratio);
    write_bytes(folder / "spoiled.exr", spoiled);
    check_refused(run_program({"info", folder / "spoiled.exr"}), 4,
                  {folder / "spoiled.exr", "got a pixelAspectRatio of ", "from 1e-6 to 1e6"});
  }
}
