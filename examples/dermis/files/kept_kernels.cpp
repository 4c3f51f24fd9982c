#include "files/kept_kernels.hpp"

#include <concepts>
#include <fstream>
#include <functional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "taps/kept/packed.hpp"

namespace dermis::program {

namespace {

namespace fs = std::filesystem;

struct CachedFile {
  std::string path;  ///< from the folder of the program
  std::string bytes;
};

template <class Bytes, class File>
requires std::same_as<std::remove_const_t<File>, CachedFile>
void fields(Bytes& bytes, File& its) { bytes(its.path, its.bytes); }

/// PoCL writes it whenever it uses a program.
constexpr std::string_view mark_of_use = "last_accessed";

/// The folders of the programs that PoCL has used: two letters of a hash, and in there the others.
std::vector<fs::path> used_programs(const fs::path& cache) {
  std::vector<fs::path> programs;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(cache, error); entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    if (error) break;
    if (entry.depth() == 2 && entry->path().filename() == mark_of_use) programs.push_back(entry->path().parent_path());
  }
  return programs;
}

std::string name_of(const fs::path& program, const fs::path& cache) { return program.lexically_relative(cache); }

/// All of a program, in an order that does not depend on the file system. Files that vanish are left out.
std::string content_of(const fs::path& program) {
  std::map<std::string, fs::path> paths;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(program, error)) {
    if (entry.is_regular_file(error) && entry.path().filename() != mark_of_use)
      paths.emplace(entry.path().lexically_relative(program), entry.path());
  }
  std::vector<CachedFile> files;
  for (const auto& [name, path] : paths) {
    const auto size = fs::file_size(path, error);
    if (error) continue;
    std::string bytes(size, '\0');
    std::ifstream stream(path, std::ios::binary);
    if (stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
      files.push_back({name, std::move(bytes)});
  }
  Packed packed;
  packed(files);
  return packed.bytes();
}

/// False if a file cannot be written; then none of the program is there.
bool write_program(const fs::path& program, std::string_view content) {
  std::vector<CachedFile> files;
  Unpacked unpacked(content);
  unpacked(files);
  bool is_whole = unpacked.complete();
  std::error_code error;
  for (const CachedFile& file : files) {
    const fs::path path = program / file.path;
    fs::create_directories(path.parent_path(), error);
    std::ofstream stream(path, std::ios::binary);
    stream.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    is_whole = is_whole && stream.flush().good();
  }
  if (!is_whole) fs::remove_all(program, error);
  return is_whole;
}

}  // namespace

void KeptKernels::lay_out(const fs::path& cache) {
  files_.for_each([&](std::string_view name, std::string_view content) {
    if (write_program(cache / name, content)) laid_out_.emplace(name, checksum(content));
  });
}

void KeptKernels::keep(const fs::path& cache) {
  for (const fs::path& program : used_programs(cache)) {
    const std::string name = name_of(program, cache);
    const std::string content = content_of(program);
    const auto before = laid_out_.find(name);
    if (before != laid_out_.end() && before->second == checksum(content)) {
      files_.get(name);  // it was used
    } else {
      files_.put(name, content);
    }
  }
}

int KeptKernels::drop_used(const fs::path& cache) {
  const std::vector<fs::path> programs = used_programs(cache);
  for (const fs::path& program : programs) files_.remove(name_of(program, cache));
  return static_cast<int>(programs.size());
}

}  // namespace dermis::program
