#include "exr/temporary_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include "dermis/error.hpp"
#include "exr/message_text.hpp"

namespace dermis::exr {
namespace {

namespace fs = std::filesystem;

constexpr int attempts = 16;

[[noreturn]] void cannot_write(const fs::path& target, const std::string& why) {
  throw Error(ErrorCode::output, escaped(target.string()), why, "a file that can be written");
}

std::string reason(int error) { return std::generic_category().message(error); }

/// Short, so that it fits where the target's own name does; hidden, so that no "*.exr" takes it for a result.
fs::path random_name(const fs::path& folder) {
  std::random_device random;
  return folder / (".dermis-" + std::to_string(random()) + std::to_string(random()) + ".exr");
}

}  // namespace

TemporaryFile::TemporaryFile(fs::path target) : target_(std::move(target)) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  if (!target_.has_filename() || (fs::exists(status) && !fs::is_regular_file(status))) {
    cannot_write(target_, "a folder or device");
  }
  for (int i = 0; i < attempts && stream_ == nullptr; ++i) {
    path_ = random_name(target_.parent_path());
    stream_ = std::fopen(path_.c_str(), "wbx");  // x: fails if the name is taken, even by a link
    if (stream_ == nullptr && errno != EEXIST) break;
  }
  if (stream_ == nullptr) cannot_write(target_, reason(errno));
}

TemporaryFile::~TemporaryFile() {
  if (stream_ != nullptr) std::fclose(stream_);
  if (!path_.empty()) {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
}

void TemporaryFile::commit() {
  // Errors of earlier writes stay in ferror; OpenEXR's destructors, which write the tables, report none.
  if (std::fflush(stream_) != 0 || std::ferror(stream_) != 0 || ::fsync(::fileno(stream_)) != 0) {
    cannot_write(target_, reason(errno));
  }
  std::FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) cannot_write(target_, reason(errno));
  std::error_code error;
  fs::rename(path_, target_, error);
  if (error) cannot_write(target_, error.message());
  path_.clear();
}

}  // namespace dermis::exr
