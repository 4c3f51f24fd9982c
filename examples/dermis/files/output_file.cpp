#include "files/output_file.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <system_error>

#include "dermis/error.hpp"
#include "report/standard_output.hpp"

namespace dermis::program {

namespace fs = std::filesystem;

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  const auto place = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(exr::target_of(path), ignored), ignored);
  };
  return place(a) == place(b);
}

void check_outputs(std::vector<NamedFile> taken, const std::vector<NamedFile>& outputs) {
  for (const auto& [argument, path] : outputs) {
    if (path.empty()) continue;
    const bool is_printed = path == "-";
    for (const NamedFile& other : taken) {
      if (is_printed != (other.path == "-")) continue;
      if (is_printed)
        throw Error(ErrorCode::usage, argument, "standard output", "a file, for " + other.argument + " is there");
      if (is_same_file(path, other.path))
        throw Error(ErrorCode::usage, argument, path, "a file that is not " + other.argument + " as well");
    }
    if (!is_printed) check_writable(argument, path);
    taken.push_back({argument, path});
  }
}

void write_file(std::string_view argument, const fs::path& path, std::string_view bytes) {
  TemporaryFile file(path, argument);
  file.write(bytes);
  file.commit();
}

void write_text_or_print(std::string_view argument, const std::string& path, std::string_view text) {
  if (path == "-")
    print(text);
  else if (!path.empty())
    write_file(argument, path, text);
}

}  // namespace dermis::program
