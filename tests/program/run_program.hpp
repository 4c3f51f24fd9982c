// Runs the dermis program and looks at what it says.
#pragma once

#include <string>
#include <vector>

struct Outcome {
  int exit_code;
  std::string output;  // stdout
  std::string errors;  // stderr, without the lines of `input`
  std::string input;   // lines of stderr that say what was taken from the picture
};

/// True if a text has such a part.
inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// True for a line of stderr "dermis: input: ...", that a kernel is larger than the picture, as it often is in pictures
/// that are made small to be quick, or how far a run that takes long is, "dermis: planning: 10 %".
bool is_input(const std::string& line);

/// The variable with the number of the OpenCL call that fails in a run.
inline constexpr const char* failing_call = "DERMIS_TEST_FAILING_CALL";

struct Surroundings {
  std::string environment = {};  ///< one more variable, "NAME=value"
  std::string folder = {};       ///< where the program runs; empty: where the tests do
};

/// Runs the program with these arguments in a process of its own, which need not load it. The exit code is -1 if a
/// signal ends it, as one does after ten minutes.
Outcome run_program(const std::vector<std::string>& arguments, const Surroundings& surroundings = {});

/// Runs it and requires exit code 0; returns stdout.
std::string run_well(const std::vector<std::string>& arguments);

/// Requires that the program refused: this exit code, nothing on stdout, one line on stderr that holds all of `parts`.
void check_refused(const Outcome& outcome, int exit_code, const std::vector<std::string>& parts);
