// A measurement as a table, as JSON and as CSV.
#pragma once

#include <string>

#include "measure/measurement.hpp"

namespace dermis::bench {

/// For people: the machine, then one table per group of cases, then what the columns mean.
std::string table_of(const Measurement& measurement);

/// An object with version, machine, device, copy_ms by size, and rows. What was not measured is null.
std::string json_of(const Measurement& measurement);

/// One line per row, under the names that the JSON has.
std::string csv_of(const Measurement& measurement);

}  // namespace dermis::bench
