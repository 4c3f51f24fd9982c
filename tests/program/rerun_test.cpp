// Sequences whose frames are read, filtered and written side by side: what a second run makes again, what it would do,
// what is left when one is ended, and how far it is.
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dermis/exr.hpp"
#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;
using dermis::exr::Picture;
using Words = std::vector<std::string>;

namespace {

/// Frames 1 to `count` that differ, filtered into out.#.exr.
struct MadeShot {
  TemporaryFolder folder;
  int count;

  explicit MadeShot(int frames, int width = 30, int height = 20) : count(frames) {
    const MadeScene scene = make_scene(folder / "scene.exr", "sphere", width, height, 3);
    for (int frame = 1; frame <= count; ++frame) {
      const std::vector<float> light(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                     static_cast<float>(frame) / 8);
      PictureCopy(scene.path).with("ViewLayer.DiffDir.R", light).write(input(frame));
    }
    write_bytes(folder / "profile.json", profile("0.4"));
  }

  static std::string profile(const std::string& red) {
    return R"({"terms": [{"variance_mm2": 0.2, "weight": [)" + red +
           R"(, 0.6, 0.8]}, {"variance_mm2": 2, "weight": [0.6, 0.4, 0.2]}]})";
  }

  std::string input(int frame) const { return folder / ("in." + std::to_string(frame) + ".exr"); }
  std::string output(int frame, const std::string& name = "out") const {
    return folder / (name + "." + std::to_string(frame) + ".exr");
  }

  Words words(const std::string& name = "out", const std::string& quality = "draft") const {
    return {"filter",
            folder / "in.#.exr",
            "-o",
            folder / (name + ".#.exr"),
            "--mm-per-unit",
            "1",
            "--material",
            "1=gaussians:" + (folder / "profile.json"),
            "--quality",
            quality};
  }

  Outcome filter(const Words& more = {}, const std::string& quality = "draft") const {
    Words all = words("out", quality);
    all.insert(all.end(), more.begin(), more.end());
    return run_program(all);
  }

  /// A file that was renamed into its place is another one.
  std::vector<ino_t> files() const {
    std::vector<ino_t> all;
    for (int frame = 1; frame <= count; ++frame) {
      struct stat status = {};
      all.push_back(stat(output(frame).c_str(), &status) == 0 ? status.st_ino : 0);
    }
    return all;
  }
};

/// Which frames a second run has made again, as "2 3"; those that it left it says so of.
std::string made_again(const MadeShot& shot, const Outcome& outcome, const std::vector<ino_t>& before) {
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  const std::vector<ino_t> after = shot.files();
  std::string again;
  for (int frame = 1; frame <= shot.count; ++frame) {
    const auto i = static_cast<std::size_t>(frame - 1);
    const bool is_left = before[i] == after[i];
    if (!is_left) again += (again.empty() ? "" : " ") + std::to_string(frame);
    CHECK(has(outcome.errors, shot.output(frame) + " is there already\n") == is_left);
  }
  return again;
}

}  // namespace

TEST_CASE("skip-existing leaves what is whole and as asked for, and makes the rest again, with the reason") {
  const MadeShot shot(3);
  CHECK(shot.filter().exit_code == 0);
  const std::vector<std::string> results = {bytes_of_file(shot.output(1)), bytes_of_file(shot.output(2)),
                                            bytes_of_file(shot.output(3))};
  const auto again = [&](const std::string& reason, const Words& more = {}, const std::string& quality = "draft") {
    const std::vector<ino_t> before = shot.files();
    Words words = {"--skip-existing"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = shot.filter(words, quality);
    INFO("reason: " << reason);
    CHECK((reason.empty() || has(outcome.errors, reason)));
    CHECK(has(outcome.errors, " is made again: ") == !reason.empty());
    return made_again(shot, outcome, before);
  };
  CHECK(again("") == "");
  // Which change no result.
  CHECK(again("", {"--threads", "1", "--frames", "1-3", "--device-memory", "1000", "--memory-limit", "4G"}) == "");

  // Cut, a changed pixel, another file, none.
  write_bytes(shot.output(1), results[0].substr(0, results[0].size() - 1));
  fs::copy_file(shot.input(3), shot.output(3), fs::copy_options::overwrite_existing);
  CHECK(again("out.3.exr is made again: it is no result of dermis") == "1 3");
  std::string spoiled = results[1];
  spoiled[spoiled.size() / 2] = static_cast<char>(spoiled[spoiled.size() / 2] ^ 1);
  write_bytes(shot.output(2), spoiled);
  fs::remove(shot.output(1));
  CHECK(again("out.2.exr is made again: it has ") == "1 2");
  for (int frame = 1; frame <= 3; ++frame)
    CHECK((bytes_of_file(shot.output(frame)) == results[static_cast<std::size_t>(frame - 1)]));

  Picture old = Picture::read(shot.output(2));
  old.set_attribute("dermis:version", "0.0.1");
  old.write(shot.output(2));
  CHECK(again("out.2.exr is made again: it is of dermis 0.0.1") == "2");

  const std::string input = bytes_of_file(shot.input(3));
  fs::copy_file(shot.input(2), shot.input(3), fs::copy_options::overwrite_existing);
  CHECK(again("out.3.exr is made again: it was made from in.3.exr, ") == "3");
  write_bytes(shot.folder / "profile.json", MadeShot::profile("0.5"));
  CHECK(again("it was made from profile.json, ") == "1 2 3");
  CHECK(again("it was made with quality=\"draft\", not quality=\"preview\"", {}, "preview") == "1 2 3");
  CHECK(again("", {}, "preview") == "");
  CHECK(again("there is no " + (shot.folder / "p.1.png"), {"--preview", shot.folder / "p.#.png"}, "preview") ==
        "1 2 3");

  check_refused(run_program({"filter", shot.input(1), "--in-place", "--skip-existing", "--mm-per-unit", "1",
                             "--material", "1=skin"}),
                2, {"--skip-existing: got it with --in-place"});
}

TEST_CASE("a dry run says what would be done, and does nothing") {
  const MadeShot shot(3);
  CHECK(shot.filter({"--frames", "1"}).exit_code == 0);
  const std::string first = bytes_of_file(shot.output(1));
  PictureCopy(shot.input(3)).with("ViewLayer.IndexMA.X", std::vector<float>(600, 9)).write(shot.input(3));
  const std::size_t files = shot.folder.file_count();
  fs::create_directory(shot.folder / "cache");
  Words words = shot.words();
  words.insert(words.end(), {"--dry-run", "--skip-existing", "--frames", "1-4"});
  const Outcome outcome = run_program(words, {.environment = "POCL_CACHE_DIR=" + (shot.folder / "cache")});
  INFO(outcome.output << outcome.errors);
  CHECK(outcome.exit_code == 8);
  CHECK(has(outcome.errors, "got no frames 4, want"));
  CHECK(has(outcome.output, shot.input(1) + ": " + shot.output(1) + " is there already\n"));
  const auto describes = [&](int frame, const std::string& what) {
    const std::string line = shot.input(frame) + ": 30 x 20, is " + what + " as " + shot.output(frame) +
                             R"(, \d+ MiB of host memory, \d+ MiB of device memory\n)";
    return std::regex_search(outcome.output, std::regex(line));
  };
  CHECK(describes(2, "filtered"));
  CHECK(describes(3, "copied"));
  CHECK(has(outcome.output, "1 to filter, 1 to copy, 1 there already; about "));
  CHECK(shot.folder.file_count() == files + 1);
  CHECK(bytes_of_file(shot.output(1)) == first);
  for (const auto& entry : fs::recursive_directory_iterator(shot.folder / "cache"))
    CHECK(entry.path().extension() != ".so");
}

TEST_CASE("a frame that cannot be written is named, and those beside it are whole") {
  const MadeShot shot(4, 60, 40);
  // Noise takes more room than the limit on files, under which what the driver keeps of kernels stays.
  constexpr int limit_kib = 4096;
  Random random(72);
  std::vector<float> noise(2400);
  PictureCopy noisy(shot.input(3));
  for (int channel = 0; channel < 600; ++channel) {
    for (float& value : noise) value = static_cast<float>(random.uniform(0, 1));
    noisy.with("ViewLayer.Noise" + std::to_string(channel) + ".R", noise);
  }
  noisy.write(shot.input(3));
  CHECK(shot.filter({"--frames", "1,2,4"}).exit_code == 0);  // and kernels are there
  std::vector<std::string> results;
  for (const int frame : {1, 2, 4}) {
    results.push_back(bytes_of_file(shot.output(frame)));
    fs::remove(shot.output(frame));
  }
  std::string call = "ulimit -f " + std::to_string(limit_kib) + "; '" + std::string(DERMIS_PROGRAM) + "'";
  for (const std::string& word : shot.words()) call += " '" + word + "'";
  const int status = std::system((call + " >/dev/null 2>'" + (shot.folder / "errors") + "'").c_str());
  const std::string errors = bytes_of_file(shot.folder / "errors");
  INFO(errors);
  CHECK(WEXITSTATUS(status) == 8);
  CHECK(has(errors, "dermis: error: " + shot.input(3) + ": " + shot.output(3) + ": got File too large"));
  CHECK(has(errors, "1 of 4 pictures failed"));
  CHECK_FALSE(fs::exists(shot.output(3)));
  std::size_t i = 0;
  for (const int frame : {1, 2, 4}) CHECK((bytes_of_file(shot.output(frame)) == results[i++]));
}

TEST_CASE("whatever ends a sequence, results are whole, and a second run completes them to the same bits") {
  const MadeShot shot(6, 60, 40);
  Random random(73);
  run_well(shot.words("whole"));
  for (const int number : {SIGTERM, SIGKILL, SIGINT}) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      signal(number, SIG_DFL);  // as it is where nobody has put the tests into the background
      Words words = shot.words();
      words.insert(words.begin(), DERMIS_PROGRAM);
      words.emplace_back("--quiet");
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(DERMIS_PROGRAM, arguments.data());
      _exit(127);
    }
    const auto wait_ms = static_cast<unsigned>(random.integer(50, 1500));
    INFO("signal " << number << " after " << wait_ms << " ms");
    usleep(1000 * wait_ms);
    kill(child, number);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
    for (const auto& entry : fs::directory_iterator(shot.folder / ".")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("out.")) CHECK_NOTHROW(Picture::read(entry.path()));
      if (name.starts_with(".dermis-")) {
        CHECK(number == SIGKILL);
        fs::remove(entry.path());
      }
    }
    CHECK(shot.filter({"--skip-existing", "--quiet"}).exit_code == 0);
    for (int frame = 1; frame <= shot.count; ++frame) {
      CHECK((bytes_of_file(shot.output(frame)) == bytes_of_file(shot.output(frame, "whole"))));
      if (random.coin()) fs::remove(shot.output(frame));
    }
  }
}

namespace {

/// Frames 1 to 4: as it should be, cut, of another material, not there.
struct ShotWithFaults {
  TemporaryFolder folder;

  ShotWithFaults() {
    const MadeScene scene = make_scene(folder / "in.1.exr", "sphere", 30, 20, 3);
    const std::string bytes = bytes_of_file(scene.path);
    write_bytes(folder / "in.2.exr", bytes.substr(0, bytes.size() / 2));
    PictureCopy(scene.path).with("ViewLayer.IndexMA.X", std::vector<float>(600, 9)).write(folder / "in.3.exr");
  }

  Outcome filter(const std::string& frames, const Words& more) const {
    Words words = {"filter", folder / "in.#.exr", "-o",    folder / "out.#.exr", "--mm-per-unit", "1", "--material",
                   "1=skin", "--quality",         "draft", "--frames",           frames};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
};

}  // namespace

TEST_CASE("progress says on standard output what farms look for, from 0 to 100 %") {
  const ShotWithFaults shot;
  const std::vector<std::pair<std::string, std::string>> styles = {{"percent", R"(Progress: (\d+)%)"},
                                                                   {"alf", R"(ALF_PROGRESS (\d+)%)"},
                                                                   {"openjd", R"(openjd_progress: (\d+\.\d))"}};
  for (const auto& [style, form] : styles) {
    const Outcome outcome = shot.filter("1,3", {"--progress", style, "--quiet"});
    INFO(style << '\n' << outcome.output << outcome.errors);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.errors.empty());
    double last = -1;
    bool has_status = false;
    std::istringstream lines(outcome.output);
    for (std::string line; std::getline(lines, line);) {
      std::smatch number;
      if (std::regex_match(line, number, std::regex(form))) {
        const double percent = std::stod(number[1]);
        CHECK(percent >= last);
        last = percent;
      } else {
        CHECK(style == "openjd");
        CHECK(line.starts_with("openjd_status: "));
        has_status = has_status || line == "openjd_status: 1 of 2, planning";
      }
    }
    CHECK(last == 100);
    CHECK(has_status == (style == "openjd"));
  }
  CHECK(shot.filter("1", {"--progress", "auto", "--quiet"}).output.empty());
  check_refused(shot.filter("1", {"--progress", "alf", "--stats-json", "-"}), 2,
                {"--progress: got alf with --stats-json"});
}

TEST_CASE("report has a record of each picture, and no end before the call has one") {
  const ShotWithFaults shot;
  const std::string path = shot.folder / "report.json";
  const auto report = [&] {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
  };
  const Outcome outcome = shot.filter("1-4", {"--report", path});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 8);
  nlohmann::json all = report();
  CHECK(all["exit_code"] == 8);
  CHECK(has(all["config"], "quality"));
  REQUIRE(all["pictures"].size() == 4);
  const auto record = [&](std::size_t i, int frame, const std::string& status) {
    const nlohmann::json& its = all["pictures"][i];
    CHECK(its["frame"] == frame);
    CHECK(its["input"] == shot.folder / ("in." + std::to_string(frame) + ".exr"));
    CHECK(its["status"] == status);
    return its;
  };
  record(0, 4, "missing");
  const nlohmann::json filtered = record(1, 1, "filtered");
  CHECK(filtered["output"] == shot.folder / "out.1.exr");
  CHECK(filtered["views"][0]["pixels"]["scattered"].get<int>() > 0);
  CHECK(filtered["views"][0]["times_ms"]["write"].get<double>() > 0);
  const nlohmann::json failed = record(2, 2, "failed");
  CHECK(failed["exit_code"] == 4);
  CHECK(has(failed["message"], "in.2.exr"));
  record(3, 3, "copied");

  CHECK(shot.filter("1", {"--report", path, "--skip-existing"}).exit_code == 0);
  all = report();
  CHECK(all["exit_code"] == 0);
  record(0, 1, "skipped");
  check_refused(shot.filter("1", {"--report", shot.folder / "none/report.json"}), 6, {"--report: got"});
  CHECK(run_program({"filter", shot.folder / "in.2.exr", "-o", shot.folder / "x.exr", "--mm-per-unit", "1", "--profile",
                     "skin", "--report", path})
            .exit_code == 4);
  all = report();
  CHECK(all["exit_code"] == 4);
  record(0, 2, "failed");
}
