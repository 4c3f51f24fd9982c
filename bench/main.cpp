// dermis-bench: time against error of every way to filter one picture.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <fstream>

#include "dermis/error.hpp"
#include "paper.hpp"
#include "report.hpp"

namespace {

struct Arguments {
  std::string picture;
  double mm_per_unit = 10;
  std::vector<std::string> materials = {"1=skin", "2=marble", "3=wax"};
  std::string device;
  int threads = 0;
  int rounds = 15;
  std::string json;
  std::string plot;
  std::string paper;
};

dermis::bench::Subject subject_of(const Arguments& arguments) {
  std::vector<int> ids;
  std::vector<std::string> names;
  for (const std::string& text : arguments.materials) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || text.find_first_not_of("0123456789") != equals || equals > 5) {
      throw dermis::Error(dermis::ErrorCode::usage, "--material", text, "ID=PRESET");
    }
    ids.push_back(std::stoi(text.substr(0, equals)));
    names.push_back(text.substr(equals + 1));
  }
  return dermis::bench::load_subject(arguments.picture, arguments.mm_per_unit, ids, names);
}

void report(const std::string& text) { fmt::print(stderr, "dermis-bench: {}\n", text); }

void run(const Arguments& arguments) {
  if (!arguments.paper.empty()) {
    fmt::print("{}", dermis::bench::reproduce_paper(arguments.paper, report));
    if (arguments.picture.empty()) return;
  }
  if (arguments.picture.empty()) {
    throw dermis::Error(dermis::ErrorCode::usage, "picture", "none", "an EXR file, or --paper and a folder");
  }
  const dermis::Device device = dermis::Device::open(arguments.device, arguments.threads);
  const dermis::bench::Subject subject = subject_of(arguments);
  const auto measurement =
      dermis::bench::measure(device, subject, dermis::bench::separable_cases(), arguments.rounds, report);
  fmt::print("{}", dermis::bench::table_of(measurement, subject, device.info()));
  if (!arguments.json.empty()) {
    std::ofstream file(arguments.json);
    file << dermis::bench::json_of(measurement, subject, device.info());
    if (!file.flush()) throw dermis::Error(dermis::ErrorCode::output, "--json", arguments.json, "a file to write");
  }
  if (!arguments.plot.empty()) dermis::bench::plot(arguments.plot, measurement, subject, device.info());
}

}  // namespace

int main(int argc, char** argv) {
  setenv("POCL_SIGFPE_HANDLER", "0", 0);
  Arguments arguments;
  CLI::App app(
      "Times and errors of the separable method against the exact one, on a Cycles picture with position, depth and "
      "ids.");
  app.add_option("picture", arguments.picture, "EXR file; needed without --paper");
  app.add_option("--mm-per-unit", arguments.mm_per_unit, "millimetres per scene unit")->capture_default_str();
  app.add_option("--material", arguments.materials, "ID=PRESET, repeatable")->capture_default_str();
  app.add_option("--device", arguments.device, "number or part of a name");
  app.add_option("--threads", arguments.threads, "compute units to use; 0 = all")->capture_default_str();
  app.add_option("--rounds", arguments.rounds, "rounds that count")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--json", arguments.json, "write the measurement here");
  app.add_option("--plot", arguments.plot, "draw time against error here (.svg or .png)");
  app.add_option("--paper", arguments.paper,
                 "write the claims of Jimenez et al. 2015 beside what is measured into this folder: table.md, "
                 "claims.json and figures");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(dermis::ErrorCode::usage);
  }
  try {
    run(arguments);
  } catch (const dermis::Error& error) {
    fmt::print(stderr, "dermis-bench: error: {}\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
