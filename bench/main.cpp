// dermis-bench measures time against error, of dermis and of others.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "dermis/error.hpp"
#include "files/output_file.hpp"
#include "files/pocl_cache.hpp"
#include "measure/measurement.hpp"
#include "measure/registry.hpp"
#include "measure/start_up.hpp"
#include "measure/two_builds.hpp"
#include "paper/paper.hpp"
#include "report/plots.hpp"
#include "report/progress_bar.hpp"
#include "report/report.hpp"
#include "report/standard_output.hpp"
#include "report/stress_report.hpp"
#include "walk/walk_table.hpp"

namespace {

using dermis::Error;
using dermis::ErrorCode;
namespace bench = dermis::bench;
namespace program = dermis::program;

struct Arguments {
  std::string picture;
  double mm_per_unit = 10;
  std::vector<std::string> materials = {"1=skin", "2=marble", "3=wax"};
  std::string filter;
  bool all = false;
  bool list = false;
  std::string device;
  int threads = 0;
  std::optional<int> rounds;
  double min_ms = 300;
  std::string json;
  std::string csv;
  std::string plot;
  std::string paper;
  std::string walk_table;
  bool stress = false;
  std::string against;
  std::string start_up_child;  ///< the folder of its caches
  bool answers = false;
};

std::vector<bench::NamedMaterial> materials_of(const Arguments& arguments) {
  std::vector<bench::NamedMaterial> materials;
  for (const std::string& text : arguments.materials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || text.find_first_not_of("0123456789") != equals || equals > 5) {
      throw Error(ErrorCode::usage, "--material", text, "ID=PRESET");
    }
    materials.push_back({std::stoi(text.substr(0, equals)), text.substr(equals + 1)});
  }
  return materials;
}

/// If nobody can be told, the work goes on.
void say(const std::string& text) { std::fputs(fmt::format("dermis-bench: {}\n", text).c_str(), stderr); }

bench::Setup setup_of(const Arguments& arguments) {
  bench::Setup setup{.device = arguments.device, .threads = arguments.threads, .min_ms = arguments.min_ms};
  if (!arguments.picture.empty()) {
    setup.picture = bench::read_picture(arguments.picture, arguments.mm_per_unit, materials_of(arguments));
    setup.rounds = 15;
    setup.enough_ms = HUGE_VAL;
  }
  if (arguments.rounds) setup.rounds = *arguments.rounds;
  return setup;
}

/// What the other build has to know to have the same cases.
std::vector<std::string> arguments_of_builds(const Arguments& arguments) {
  std::vector<std::string> result = {"--device", arguments.device, "--threads", std::to_string(arguments.threads)};
  if (arguments.picture.empty()) return result;
  result.insert(result.end(), {arguments.picture, "--mm-per-unit", fmt::format("{}", arguments.mm_per_unit)});
  for (const std::string& material : arguments.materials) result.insert(result.end(), {"--material", material});
  return result;
}

/// The cases on a picture are of its size.
std::vector<bench::Case> on(const std::optional<bench::Scene>& picture, std::vector<bench::Case> cases) {
  if (!picture) return cases;
  for (bench::Case& what : cases) what.scene = picture->spec;
  return cases;
}

void answer(const Arguments& arguments) {
  const bench::Setup setup = setup_of(arguments);
  std::vector<bench::Case> cases = setup.picture ? bench::picture_cases() : bench::all_cases();
  if (!setup.picture) {
    for (bench::Case& what : bench::default_cases()) cases.push_back(std::move(what));
  }
  bench::answer_requests(on(setup.picture, std::move(cases)), setup);
}

/// Times against another build are of cases that run again and again in one process, and have no errors.
std::vector<bench::Case> with_rounds(std::vector<bench::Case> cases) {
  std::erase_if(cases, [](const bench::Case& what) { return what.family == bench::Family::start_up; });
  if (cases.empty()) throw Error(ErrorCode::usage, "--against", "start-up cases only", "cases that run more than once");
  return cases;
}

void measure(const Arguments& arguments) {
  const bool is_picture = !arguments.picture.empty();
  const bool is_against = !arguments.against.empty();
  if (!is_picture && arguments.threads > 0) {
    throw Error(ErrorCode::usage, "--threads", std::to_string(arguments.threads), "a picture; cases name their own");
  }
  if (is_against && !arguments.plot.empty()) {
    throw Error(ErrorCode::usage, "--plot", "--against, which measures no errors", "one of both");
  }
  std::vector<bench::Case> cases = bench::matching(is_picture      ? bench::picture_cases()
                                                   : arguments.all ? bench::all_cases()
                                                                   : bench::default_cases(),
                                                   arguments.filter);
  if (is_against) cases = with_rounds(std::move(cases));
  if (arguments.list) {
    for (const bench::Case& what : cases) program::print(what.name() + "\n");
    return;
  }
  if (!is_picture && arguments.all && arguments.filter.empty()) {
    throw Error(ErrorCode::usage, "--all", fmt::format("{} cases", cases.size()), "a --filter, or --list");
  }
  if (!arguments.json.empty()) program::check_writable("--json", arguments.json);
  if (!arguments.csv.empty()) program::check_writable("--csv", arguments.csv);
  if (!arguments.plot.empty()) bench::prepare_plots(arguments.plot);
  std::optional<bench::TwoBuilds> builds;
  if (is_against) builds.emplace(arguments.against, arguments_of_builds(arguments));
  bench::Setup setup = setup_of(arguments);
  if (is_against) setup.builds = &*builds;
  if (is_picture && !is_against) cases.insert(cases.begin(), bench::picture_reference());
  cases = on(setup.picture, std::move(cases));
  bench::Measurement measurement;
  {
    program::ProgressBar progress("dermis-bench");
    measurement = bench::measure_cases(cases, setup,
                                       [&](double share, const std::string& what) { progress.update(share, what); });
  }
  measurement.against = arguments.against;
  program::print(bench::table_of(measurement));
  if (!arguments.json.empty()) program::write_file("--json", arguments.json, bench::json_of(measurement));
  if (!arguments.csv.empty()) program::write_file("--csv", arguments.csv, bench::csv_of(measurement));
  if (!arguments.plot.empty()) bench::draw_plots(arguments.plot, measurement);
}

void run(const Arguments& arguments) {
  if (!arguments.start_up_child.empty()) return bench::run_start_up_child(arguments.device, arguments.start_up_child);
  if (!std::isfinite(arguments.min_ms) || arguments.min_ms < 0) {
    throw Error(ErrorCode::usage, "--min-ms", fmt::format("{}", arguments.min_ms), "milliseconds from 0 on");
  }
  if (arguments.answers) return answer(arguments);
  if (!arguments.walk_table.empty()) {
    program::check_writable("--walk-table", arguments.walk_table);
    return program::write_file("--walk-table", arguments.walk_table, bench::make_walk_table());
  }
  if (!arguments.against.empty() && (arguments.stress || !arguments.paper.empty())) {
    throw Error(ErrorCode::usage, "--against", arguments.stress ? "--stress" : "--paper", "cases that have times");
  }
  if (arguments.stress) {
    if (!arguments.plot.empty()) bench::prepare_plots(arguments.plot);
    const dermis::Device device = dermis::Device::open(arguments.device, arguments.threads);
    program::print(bench::stress_report(device, arguments.plot, say));
    return;
  }
  if (!arguments.paper.empty()) program::print(bench::reproduce_paper(arguments.paper, say));
  if (arguments.paper.empty() || !arguments.picture.empty()) measure(arguments);
}

void add_options(CLI::App& app, Arguments& arguments) {
  CLI::Option* picture =
      app.add_option("picture", arguments.picture,
                     "EXR file of Cycles with position, depth and ids, to measure on in place of made scenes");
  app.add_option("--mm-per-unit", arguments.mm_per_unit, "of the picture: millimetres per scene unit")
      ->needs(picture)
      ->capture_default_str();
  app.add_option("--material", arguments.materials, "of the picture: ID=PRESET, repeatable")
      ->allow_extra_args(false)
      ->needs(picture)
      ->capture_default_str();
  app.add_option("--filter", arguments.filter, "only cases whose name has a match of this regular expression");
  app.add_flag("--all", arguments.all, "let --filter choose from every combination, not only from the default cases");
  app.add_flag("--list", arguments.list, "print the names of the cases and stop");
  app.add_option("--device", arguments.device, "number or part of a name");
  app.add_option("--threads", arguments.threads, "for the picture: compute units to use; 0 = all")
      ->capture_default_str();
  app.add_option("--rounds", arguments.rounds, "least runs of a case; 7, or 15 for a picture")
      ->check(CLI::Range(1, 1000));
  app.add_option("--min-ms", arguments.min_ms, "least time for all runs of a case")->capture_default_str();
  app.add_option("--json", arguments.json, "write the measurement here");
  app.add_option("--csv", arguments.csv, "write the rows here");
  app.add_option("--plot", arguments.plot, "draw time against error, width, coverage and pixels into this folder");
  app.add_option("--against", arguments.against,
                 "time each case in turn with bin/dermis-bench of this build folder, and tell the ratio; no errors");
  app.add_flag("--stress", arguments.stress, "instead: a table of cases with numbers that no picture should hold");
  app.add_option("--paper", arguments.paper,
                 "write the claims of Jimenez et al. 2015 beside what is measured into this folder: table.md, "
                 "claims.json and figures");
  app.add_option("--walk-table", arguments.walk_table,
                 "instead: make src/profile/walk_table.cpp, the table behind the profile of random walks, again");
  app.add_option("--start-up-child", arguments.start_up_child)->group("");
  app.add_flag(bench::answer_option, arguments.answers)->group("");
}

}  // namespace

int main(int argc, char** argv) {
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  Arguments arguments;
  CLI::App app("Times and errors of dermis and of others, on made scenes or on a picture.");
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ErrorCode::usage);
  }
  int code = 0;
  try {
    program::choose_cache();
    if (const auto warning = program::fill_cache()) say("warning: " + *warning);
    run(arguments);
    if (const auto problem = program::output_problem())
      throw Error(ErrorCode::output, "standard output", *problem, "all of it out");
  } catch (const Error& error) {
    say(std::string("error: ") + error.what());
    code = static_cast<int>(error.code());
  }
  program::close_cache();
  return code;
}
