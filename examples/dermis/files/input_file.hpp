/// Text and JSON files that arguments name.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "exr/text_file.hpp"

namespace dermis::program {

using exr::read_text;

/// Reads a JSON file of at most 32 levels. Throws as read_text, and Error(input_unsupported) that names argument and
/// file.
nlohmann::json read_json(std::string_view argument, const std::string& path, std::string_view wanted);

/// A value of a JSON file, for an error: at most 80 characters of it.
std::string printed(const nlohmann::json& value);

}  // namespace dermis::program
