#include "files/input_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::program {

using nlohmann::json;

json read_json(std::string_view argument, const std::string& path, std::string_view wanted) {
  constexpr int most_levels = 32;
  const auto fail = [&](std::string_view seen, std::string_view want) {
    throw Error(ErrorCode::input_unsupported, fmt::format("{} {}", argument, path), seen, want);
  };
  const auto check = [&](int level, json::parse_event_t, const json&) {
    if (level > most_levels) fail(fmt::format("more than {} levels", most_levels), "JSON of fewer");
    return true;
  };
  const std::string text = read_text(argument, path, wanted);
  try {
    return json::parse(text, check);
  } catch (const json::exception& error) {
    fail(exr::escaped(error.what(), 200), "JSON");
  }
  return {};
}

std::string printed(const json& value) {
  return exr::shown(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace dermis::program
