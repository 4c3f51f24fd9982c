/// What a result says in its attributes of how it was made, by which a later call tells whether to make it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

struct ResultRecord {
  std::string version;   ///< of dermis
  std::string settings;  ///< one to a line, as TOML
  std::string inputs;    ///< as input_lines makes them
};

/// A line for each file: its name without folders, its size and its checksum. Throws Error(input_missing) if one cannot
/// be read.
std::string input_lines(const std::vector<std::string>& paths);

/// Sets the attributes dermis:version, dermis:config and dermis:inputs.
void set_record(exr::Picture& picture, const ResultRecord& record);

/// Why the file at `path` is not the result that the record is of: it is damaged, or says something else. None if it
/// is, with all of its pixels.
std::optional<std::string> why_not(const std::string& path, const ResultRecord& record);

}  // namespace dermis::program
