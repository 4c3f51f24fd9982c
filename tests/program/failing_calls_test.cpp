// A call of OpenCL fails in a run of the program: exit code 7, one line, and no output.
#include <filesystem>
#include <string>
#include <vector>

#include "program/made_picture.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

namespace {

using Words = std::vector<std::string>;

/// Commands that write `output`, each with more calls than any of the numbers that are tried.
struct FailingRuns {
  TemporaryFolder folder;
  std::string outputs = folder / "out";
  std::string output = outputs + "/out.exr";
  std::vector<Words> commands;

  FailingRuns() {
    const std::string lights = folder / "lights.json";
    const MadeScene scene = make_scene(folder / "in.exr", "sphere", 33, 21, 2);
    run_well({"scene", "sphere", "-o", folder / "lit.exr", "--size", "33x21", "--shadow-map", folder / "map.exr",
              "--lights", lights});
    std::filesystem::create_directory(outputs);
    const auto filter = [&](const Words& more) {
      Words words = filter_arguments(scene, output, {"--material", "1=skin"});
      words.insert(words.end(), more.begin(), more.end());
      commands.push_back(words);
    };
    filter({"--quality", "draft"});
    filter({"--method", "disc", "--samples", "4", "--preview", outputs + "/out.png"});
    commands.push_back({"light", folder / "lit.exr", "--lights", lights, "-o", output});
  }

  void fail(const Words& command, int call) const {
    const std::string number = std::to_string(call);
    CAPTURE(test_seed(), command[0], command[1], call);
    const Outcome outcome = run_program(command, {.environment = std::string(failing_call) + "=" + number});
    if (outcome.exit_code == 0) {  // it does not matter, as the one that asks whether there is a device of a kind
      CHECK(std::filesystem::exists(output));
      std::filesystem::remove_all(outputs);
      std::filesystem::create_directory(outputs);
      return;
    }
    check_refused(outcome, 7, {});
    CHECK(std::filesystem::is_empty(outputs));
  }
};

constexpr int most_calls = 120;

}  // namespace

TEST_CASE("a call of OpenCL that fails ends a run with code 7 and no output", "[failing]") {
  const FailingRuns runs;
  Random random(9701);
  for (const Words& command : runs.commands) runs.fail(command, random.integer(1, most_calls));
}

TEST_CASE("every call of OpenCL fails in a run", "[.every-call]") {
  const FailingRuns runs;
  for (const Words& command : runs.commands)
    for (int call = 1; call <= most_calls; ++call) runs.fail(command, call);
}
