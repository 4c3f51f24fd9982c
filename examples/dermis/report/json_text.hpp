/// JSON as it is printed.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dermis::program {

/// Indented, with a line end, in ASCII, so that no name of a file steers the terminal. Bytes in names that are not
/// UTF-8 become U+FFFD.
template <class Json>
std::string json_text(const Json& value) {
  return value.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace dermis::program
