// dermis-bench: time against error, of dermis and of others.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "dermis/error.hpp"
#include "measure/matching.hpp"
#include "measure/registry.hpp"
#include "measure/start_up.hpp"
#include "paper/paper.hpp"
#include "report/picture_report.hpp"
#include "report/plots.hpp"
#include "report/report.hpp"
#include "stress/stress.hpp"
#include "support/progress.hpp"

namespace {

using dermis::Error;
using dermis::ErrorCode;
namespace bench = dermis::bench;

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
  bool stress = false;
  bool start_up_child = false;
};

/// A file that is opened before the measurement, so that a wrong name costs no time.
class OutputFile {
 public:
  OutputFile(std::string_view option, const std::string& path) : option_(option), path_(path) {
    if (path.empty()) return;
    file_.open(path);
    check();
  }

  void write(const std::string& text) {
    if (path_.empty()) return;
    file_ << text << std::flush;
    check();
  }

 private:
  void check() const {
    if (!file_) throw Error(ErrorCode::output, option_, path_, "a file to write");
  }

  std::string option_, path_;
  std::ofstream file_;
};

bench::Subject subject_of(const Arguments& arguments) {
  std::vector<int> ids;
  std::vector<std::string> names;
  for (const std::string& text : arguments.materials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || text.find_first_not_of("0123456789") != equals || equals > 5) {
      throw Error(ErrorCode::usage, "--material", text, "ID=PRESET");
    }
    ids.push_back(std::stoi(text.substr(0, equals)));
    names.push_back(text.substr(equals + 1));
  }
  return bench::load_subject(arguments.picture, arguments.mm_per_unit, ids, names);
}

void say(const std::string& text) { fmt::print(stderr, "dermis-bench: {}\n", text); }

template <class Named, class Name>
void print_names(const std::vector<Named>& cases, Name name) {
  for (const Named& what : cases) fmt::print("{}\n", std::invoke(name, what));
}

void measure_picture(const Arguments& arguments) {
  const auto cases = bench::matching(bench::picture_cases(), &bench::PictureCase::name, arguments.filter);
  if (arguments.list) return print_names(cases, &bench::PictureCase::name);
  if (!arguments.csv.empty()) throw Error(ErrorCode::usage, "--csv", "a picture", "no picture: --json has its rows");
  OutputFile json("--json", arguments.json);
  if (!arguments.plot.empty()) bench::prepare_plots(arguments.plot);
  const dermis::Device device = dermis::Device::open(arguments.device, arguments.threads);
  const bench::Subject subject = subject_of(arguments);
  constexpr int default_rounds = 15;
  const auto measurement =
      bench::measure_picture(device, subject, cases, arguments.rounds.value_or(default_rounds), say);
  fmt::print("{}", bench::table_of(measurement, subject, device.info()));
  json.write(bench::json_of(measurement, subject, device.info()));
  if (!arguments.plot.empty()) {
    bench::plot(std::filesystem::path(arguments.plot) / "picture_time_error.svg", measurement, subject, device.info());
  }
}

void measure_made_scenes(const Arguments& arguments) {
  if (arguments.threads > 0) {
    throw Error(ErrorCode::usage, "--threads", std::to_string(arguments.threads), "a picture; cases name their own");
  }
  const auto cases = bench::matching(arguments.all ? bench::all_cases() : bench::default_cases(), &bench::Case::name,
                                     arguments.filter);
  if (arguments.list) return print_names(cases, &bench::Case::name);
  if (arguments.all && arguments.filter.empty()) {
    throw Error(ErrorCode::usage, "--all", fmt::format("{} cases", cases.size()), "a --filter, or --list");
  }
  OutputFile json("--json", arguments.json);
  OutputFile csv("--csv", arguments.csv);
  if (!arguments.plot.empty()) bench::prepare_plots(arguments.plot);
  bench::Effort effort{.min_ms = arguments.min_ms};
  if (arguments.rounds) effort.rounds = *arguments.rounds;
  bench::Measurement measurement;
  {
    bench::Progress progress;
    measurement = bench::measure_cases(cases, arguments.device, effort, std::ref(progress));
  }
  fmt::print("{}", bench::table_of(measurement));
  json.write(bench::json_of(measurement));
  csv.write(bench::csv_of(measurement));
  if (!arguments.plot.empty()) bench::draw_plots(arguments.plot, measurement);
}

void run(const Arguments& arguments) {
  if (arguments.start_up_child) return bench::run_start_up_child(arguments.device);
  if (!std::isfinite(arguments.min_ms) || arguments.min_ms < 0) {
    throw Error(ErrorCode::usage, "--min-ms", fmt::format("{}", arguments.min_ms), "milliseconds from 0 on");
  }
  if (arguments.stress) {
    if (!arguments.plot.empty()) bench::prepare_plots(arguments.plot);
    const dermis::Device device = dermis::Device::open(arguments.device, arguments.threads);
    fmt::print("{}", bench::stress_report(device, arguments.plot, say));
    return;
  }
  if (!arguments.paper.empty()) {
    fmt::print("{}", bench::reproduce_paper(arguments.paper, say));
  } else if (arguments.picture.empty()) {
    measure_made_scenes(arguments);
  }
  if (!arguments.picture.empty()) measure_picture(arguments);
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
  app.add_flag("--stress", arguments.stress, "instead: a table of what becomes of numbers that no picture should hold");
  app.add_option("--paper", arguments.paper,
                 "write the claims of Jimenez et al. 2015 beside what is measured into this folder: table.md, "
                 "claims.json and figures");
  app.add_flag("--start-up-child", arguments.start_up_child)->group("");
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
  try {
    run(arguments);
  } catch (const Error& error) {
    fmt::print(stderr, "dermis-bench: error: {}\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
