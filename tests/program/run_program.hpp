// Runs the dermis program and looks at what it says.
#pragma once

#include <string>
#include <vector>

struct Outcome {
  int exit_code;
  std::string output;  // stdout
  std::string errors;  // stderr
};

/// Runs `dermis` with these arguments. `environment` is put before the command, as "NAME=value" or "cd 'folder' &&".
Outcome run_program(const std::vector<std::string>& arguments, const std::string& environment = {});

/// Runs it and requires exit code 0; returns stdout.
std::string run_well(const std::vector<std::string>& arguments);

/// Requires that the program refused: this exit code, nothing on stdout, one line on stderr that holds all of `parts`.
void check_refused(const Outcome& outcome, int exit_code, const std::vector<std::string>& parts);
