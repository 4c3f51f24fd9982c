/// Results that are printed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dermis::program {

/// Prints lines on standard output, with whatever in names would steer a terminal escaped. What cannot be written shows
/// in output_problem.
void print(std::string_view lines);

/// Writes what is still held back. Why standard output lacks some of what was printed, if it does.
std::optional<std::string> output_problem();

}  // namespace dermis::program
