/// Profiles as tables in CSV files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dermis/profile.hpp"

namespace dermis::program {

/// Reads rows of r_mm,R,G,B. The first line may be a header; what follows a # and empty lines are left out. `argument`
/// is named in errors. Throws Error(input_missing) if there is no such file, Error(input_unsupported) that names the
/// line otherwise.
std::vector<TableRow> read_table(std::string_view argument, const std::string& path);

}  // namespace dermis::program
