// A measurement as a table, as JSON and as CSV.
#pragma once

#include <string>

#include "measure/measurement.hpp"

namespace dermis::bench {

/// For people: the machine, then one table per group of cases, and the meaning of their columns. The table of a picture
/// is Markdown.
std::string table_of(const Measurement& measurement);

/// An object with version, machine, device, picture, copy_ms by size, and rows. A value that was not measured is null.
std::string json_of(const Measurement& measurement);

/// One line per row, under the names of the JSON.
std::string csv_of(const Measurement& measurement);

}  // namespace dermis::bench
