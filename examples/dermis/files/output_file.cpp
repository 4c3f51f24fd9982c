#include "files/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"

namespace dermis::program {

namespace fs = std::filesystem;

void check_writable(std::string_view argument, const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  const std::string name = path.empty() ? "no name" : path.string();
  if (!path.has_filename() || fs::is_directory(status))
    throw Error(ErrorCode::output, argument, name, "the name of a file, not of a folder");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(ErrorCode::output, argument, name, "an ordinary file");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw Error(ErrorCode::output, argument, name, "a file in a folder that exists");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(ErrorCode::output, argument, name, "a file in a folder that can be written");
}

void check_outputs(std::vector<NamedFile> taken, const std::vector<NamedFile>& outputs) {
  const auto place = [](const std::string& path) { return fs::weakly_canonical(fs::absolute(path)); };
  for (const auto& [argument, path] : outputs) {
    if (path.empty()) continue;
    const bool is_printed = path == "-";
    for (const NamedFile& other : taken) {
      if (is_printed != (other.path == "-")) continue;
      if (is_printed)
        throw Error(ErrorCode::usage, argument, "standard output", "a file, for " + other.argument + " is there");
      if (place(path) == place(other.path))
        throw Error(ErrorCode::usage, argument, path, "a file that is not " + other.argument + " as well");
    }
    if (!is_printed) check_writable(argument, path);
    taken.push_back({argument, path});
  }
}

TemporaryFile::TemporaryFile(std::string_view argument, fs::path target)
    : argument_(argument), target_(std::move(target)), path_(target_) {
  path_.replace_filename(fmt::format(".{}.{}.tmp", target_.filename().string(), getpid()));
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove(path_, ignored);
}

void TemporaryFile::commit() {
  std::error_code error;
  fs::rename(path_, target_, error);
  if (error)
    throw Error(ErrorCode::output, argument_, fmt::format("{} ({})", target_.string(), error.message()),
                "a file that can be written");
  path_.clear();
}

void write_text(std::string_view argument, const fs::path& path, std::string_view text) {
  TemporaryFile temporary(argument, path);
  std::ofstream file(temporary.path(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(ErrorCode::output, argument, path.string(), "a file that can be written");
  temporary.commit();
}

void write_text_or_print(std::string_view argument, const std::string& path, std::string_view text) {
  if (path == "-")
    fmt::print("{}", text);
  else if (!path.empty())
    write_text(argument, path, text);
}

}  // namespace dermis::program
