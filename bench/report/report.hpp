// A measurement as a table, as JSON and as CSV.
#pragma once

#include <string>

#include "measure/measurement.hpp"

namespace dermis::bench {

/// A text for people has the machine, one table per group of cases, and the meaning of their columns. The table of a
/// picture is Markdown. Against another build there is one table, of times and their ratio.
std::string table_of(const Measurement& measurement);

/// The JSON is an object with version, machine, device, picture, copy_ms by size, and rows. A value that was not
/// measured is null.
std::string json_of(const Measurement& measurement);

/// The CSV has one line per row, under the names of the JSON.
std::string csv_of(const Measurement& measurement);

}  // namespace dermis::bench
