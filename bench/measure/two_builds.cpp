#include "measure/two_builds.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <utility>

#include "dermis/error.hpp"
#include "measure/runner.hpp"

namespace dermis::bench {

namespace {

std::string bench_of(const std::filesystem::path& folder) {
  std::string path = (folder / "bin" / "dermis-bench").string();
  if (access(path.c_str(), X_OK) != 0 || std::filesystem::is_directory(path)) {
    throw Error(ErrorCode::input_missing, "--against", folder.string(), "a folder with a program bin/dermis-bench");
  }
  return path;
}

}  // namespace

AnsweringProcess::AnsweringProcess(std::string path, std::vector<std::string> arguments) : path_(std::move(path)) {
  arguments.emplace_back(answer_option);
  process_.emplace(ChildProcess::Program{.path = path_, .arguments = std::move(arguments), .is_silent = true});
  if (process_->read_line() != answer_greeting) {
    throw Error(ErrorCode::usage, "--against", path_ + ", which does not answer",
                fmt::format("a build of a version that has {}", answer_option));
  }
}

std::optional<double> AnsweringProcess::run_ms(const std::string& name) {
  process_->send(name);
  const std::string answer = process_->read_line().value_or("no answer");
  if (answer == "unknown") return std::nullopt;
  char* end = nullptr;
  const double ms = std::strtod(answer.c_str(), &end);
  if (end == answer.c_str() || *end != '\0' || !(ms > 0)) {
    throw Error(ErrorCode::device, "--against", fmt::format("\"{}\" for {} from {}", answer, name, path_),
                "milliseconds");
  }
  return ms;
}

TwoBuilds::TwoBuilds(const std::filesystem::path& folder, const std::vector<std::string>& arguments)
    : own("/proc/self/exe", arguments), other(bench_of(folder), arguments) {}

void answer_requests(const std::vector<Case>& cases, const Setup& setup) {
  Stage stage(setup);
  std::map<std::string, Runner> runners;
  const auto answer_to = [&](const std::string& name) -> std::string {
    const auto what = std::find_if(cases.begin(), cases.end(), [&](const Case& one) { return one.name() == name; });
    if (what == cases.end()) return "unknown";
    try {
      if (!runners.contains(name)) runners.emplace(name, prepare(*what, stage));
      Runner& runner = runners.at(name);
      runner.run();
      return fmt::format("{}", runner.ms.back());
    } catch (const Error& error) {
      return fmt::format("error: {}", error.what());
    }
  };
  std::cout << answer_greeting << std::endl;
  for (std::string name; std::getline(std::cin, name);) std::cout << answer_to(name) << std::endl;
}

}  // namespace dermis::bench
