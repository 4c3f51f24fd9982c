// A dermis-bench of this build and one of another, which run the same cases in turn.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/measurement.hpp"
#include "support/child_process.hpp"

namespace dermis::bench {

/// The option of a dermis-bench that answers: it prints `answer_greeting`, then for each name of a case on standard
/// input one line: the milliseconds of a run, or "unknown", or "error: " and what is wrong.
inline constexpr const char* answer_option = "--answer";
inline constexpr const char* answer_greeting = "dermis-bench answers";

class AnsweringProcess {
 public:
  /// Starts a dermis-bench with these arguments and `answer_option`. Throws Error that names --against if it does not
  /// answer.
  AnsweringProcess(std::string path, std::vector<std::string> arguments);

  /// Milliseconds of one run of a case; none if the build has no case of that name. Throws Error(device) that names
  /// --against if the case fails there.
  std::optional<double> run_ms(const std::string& name);

 private:
  std::string path_;
  std::optional<ChildProcess> process_;
};

/// Both run in processes of their own: beside the one that measures, a process that only answers is up to 5 % faster.
struct TwoBuilds {
  AnsweringProcess own;
  AnsweringProcess other;

  /// `folder` is that of the other build. Throws Error that names --against if it has no bin/dermis-bench.
  TwoBuilds(const std::filesystem::path& folder, const std::vector<std::string>& arguments);
};

/// Is such a process: answers from the cases until standard input ends.
void answer_requests(const std::vector<Case>& cases, const Setup& setup);

}  // namespace dermis::bench
