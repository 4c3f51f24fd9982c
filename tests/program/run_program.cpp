#include "program/run_program.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

/// For the shell.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'')
      result.append("'\\''");
    else
      result.push_back(c);
  }
  result.insert(result.begin(), '\'');
  result.push_back('\'');
  return result;
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const std::string& environment) {
  const TemporaryFolder folder;
  std::string command = environment;
  command.append(" ").append(quoted(DERMIS_PROGRAM));
  for (const std::string& argument : arguments) command.append(" ").append(quoted(argument));
  command.append(" >").append(quoted(folder / "stdout")).append(" 2>").append(quoted(folder / "stderr"));
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / "stdout"), contents(folder / "stderr")};
}

std::string run_well(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_program(arguments);
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  return outcome.output;
}

void check_refused(const Outcome& outcome, int exit_code, const std::vector<std::string>& parts) {
  INFO("stderr: " << outcome.errors);
  CHECK(outcome.exit_code == exit_code);
  CHECK(outcome.output.empty());
  // A run that takes long has said how far it is before, "dermis: 10 %".
  std::string error = outcome.errors;
  while (error.rfind("dermis: ", 0) == 0 && error.find(" %\n") < error.find('\n')) error.erase(0, error.find('\n') + 1);
  CHECK(error.substr(0, 15) == "dermis: error: ");
  CHECK(std::count(error.begin(), error.end(), '\n') == 1);
  for (const std::string& part : parts) {
    INFO("looking for: " << part);
    CHECK(outcome.errors.find(part) != std::string::npos);
  }
}
