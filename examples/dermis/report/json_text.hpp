/// JSON as it is printed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dermis::program {

/// Indented, with a line end. Names from files may hold bytes that are not UTF-8: they become U+FFFD.
inline std::string json_text(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace dermis::program
