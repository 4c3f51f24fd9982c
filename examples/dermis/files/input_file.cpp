#include "files/input_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "dermis/error.hpp"

namespace dermis::program {

using nlohmann::json;

std::string read_text(std::string_view argument, const std::string& path, std::string_view wanted) {
  std::error_code ignored;
  std::ifstream file(path);
  if (!file || !std::filesystem::is_regular_file(path, ignored))
    throw Error(ErrorCode::input_missing, argument, path.empty() ? "no file name" : path + ", which cannot be read",
                wanted);
  return {std::istreambuf_iterator<char>(file), {}};
}

json read_json(std::string_view argument, const std::string& path, std::string_view wanted) {
  try {
    return json::parse(read_text(argument, path, wanted));
  } catch (const json::exception& error) {
    throw Error(ErrorCode::input_unsupported, std::string(argument) + " " + path, error.what(), "JSON");
  }
}

std::string printed(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 80);
}

}  // namespace dermis::program
