// Jobs for farms.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "program/run_program.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace fs = std::filesystem;

namespace {

int run_in_shell(const std::string& command) { return std::system(command.c_str()); }

}  // namespace

TEST_CASE("the tasks of a Slurm job do each frame once, and nothing if they are sent again") {
  const TemporaryFolder folder;
  const std::string inputs = folder / "it's";
  fs::create_directory(inputs);
  fs::create_directory(folder / "out");
  for (const char* frame : {"9", "10", "11"})
    run_well({"scene", "sphere", "--size", "24x16", "-o", inputs + "/a b." + frame + ".exr"});
  const std::string script = run_well({"submit",
                                       "--engine",
                                       "slurm",
                                       "--chunks",
                                       "2",
                                       "--cores",
                                       "1",
                                       "--memory-mb",
                                       "700",
                                       "--name",
                                       "shot-1",
                                       "--",
                                       "filter",
                                       inputs + "/a b.#.exr",
                                       "-o",
                                       folder / "out/s.#.exr",
                                       "--profile",
                                       "skin",
                                       "--mm-per-unit",
                                       "1",
                                       "--fov",
                                       "40",
                                       "--taps",
                                       "7",
                                       "--rank",
                                       "1"});
  CHECK(has(script, "#SBATCH --job-name=shot-1\n"));
  CHECK(has(script, "#SBATCH --array=1-2\n"));
  CHECK(has(script, "#SBATCH --cpus-per-task=1\n"));
  CHECK(has(script, "#SBATCH --mem=700M\n"));
  CHECK(has(script, "#SBATCH --requeue\n"));
  // The job names the program that made it, which is that of the tests here.
  const std::size_t command = script.find(" filter ");
  std::ofstream(folder / "job") << "exec " << DERMIS_PROGRAM << script.substr(command);
  const auto run_tasks = [&] {
    for (const char* task : {"1", "2"})
      REQUIRE(run_in_shell(std::string("SLURM_ARRAY_TASK_ID=") + task + " bash '" + (folder / "job") + "' 2>> '" +
                           (folder / "said") + "'") == 0);
  };
  run_tasks();
  std::vector<fs::file_time_type> made;
  for (const char* frame : {"9", "10", "11"}) {
    INFO("frame " << frame);
    REQUIRE(fs::exists(folder / "out/s." + frame + ".exr"));
    made.push_back(fs::last_write_time(folder / "out/s." + frame + ".exr"));
  }
  run_tasks();
  for (const char* frame : {"11", "10", "9"}) {
    CHECK(fs::last_write_time(folder / "out/s." + frame + ".exr") == made.back());
    made.pop_back();
  }
}

TEST_CASE("jobs for other farms name the chunk of a task in their own words") {
  const auto job = [](const std::string& engine) {
    return run_well({"submit", "--engine", engine, "--chunks", "12", "--cores", "3", "--", "filter", "a &<b.#.exr",
                     "-o", "o'.#.exr", "--profile", "skin", "--mm-per-unit", "1"});
  };
  CHECK(has(job("parallel"), "seq 12 | parallel "));
  CHECK(has(job("parallel"), "--threads 3 --chunk {}/12'"));
  CHECK(has(job("opencue"), "filter 'a &amp;&lt;b.#.exr' -o 'o'\\''.#.exr'"));
  CHECK(has(job("opencue"), "--chunk #IFRAME#/12</cmd>\n        <range>1-12</range>\n"));
  CHECK(has(job("opencue"), "<cores>3</cores>"));
  const std::string deadline = run_well({"submit", "--engine", "deadline", "--chunks", "12", "--", "filter",
                                         "a b.#.exr", "-o", "o.#.exr", "--profile", "skin", "--mm-per-unit", "1"});
  CHECK(has(deadline, "-frames 1-12 -chunksize 1 "));
  CHECK(has(deadline, "-arguments 'filter <QUOTE>a b.#.exr<QUOTE> -o "));
  CHECK(has(deadline, "--chunk <STARTFRAME>/12' -startupdirectory "));
}

TEST_CASE("what makes no sense of a job is refused before it is one") {
  const auto submit = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"submit", "--engine", "slurm", "--chunks", "2"});
    return run_program(words);
  };
  check_refused(submit({"--", "info", "a.exr"}), 2, {"command", "info", "filter or texture"});
  check_refused(submit({"--", "filter", "a.exr", "--profle", "skin"}), 2, {"command", "--profle"});
  check_refused(submit({"--", "filter", "a.exr", "--chunk", "1/2"}), 2, {"--chunk"});
  check_refused(submit({"--", "filter", "a.exr", "--threads=2"}), 2, {"--threads"});
  check_refused(submit({"--", "filter", "a\nb.exr"}), 2, {"command", "control characters"});
  check_refused(submit({"--name", "a b", "--", "filter", "a.exr"}), 2, {"--name", "a b"});
  check_refused(run_program({"submit", "--engine", "slurm", "--chunks", "0", "--", "filter", "a.exr"}), 2,
                {"--chunks", "1..1000"});
  check_refused(run_program({"submit", "--engine", "deadline", "--chunks", "2", "--", "filter", "a\"b.exr"}), 2,
                {"command", "quotation marks"});
  check_refused(run_program({"submit", "--engine", "opencue", "--chunks", "2", "--send", "--", "filter", "a.exr"}), 2,
                {"--send"});
}
