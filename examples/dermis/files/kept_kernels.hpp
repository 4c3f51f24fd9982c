/// Kernels that PoCL has compiled, kept from run to run with a checksum: PoCL loads and runs whatever is in its cache.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "taps/kept/kept_files.hpp"

namespace dermis::program {

/// The programs of PoCL's cache, each in a file of its own with all that PoCL has written of it.
class KeptKernels {
 public:
  /// A folder that is not this user's alone keeps nothing.
  explicit KeptKernels(const std::filesystem::path& folder) : files_(folder.string(), ".kernels") {}

  /// Writes the programs that are unchanged to where PoCL looks for them in its cache, and removes the others.
  void lay_out(const std::filesystem::path& cache);

  /// Keeps what PoCL has added to a cache since it was laid out.
  void keep(const std::filesystem::path& cache);

  /// Drops the programs that PoCL has used in a cache. Returns their number.
  int drop_used(const std::filesystem::path& cache);

 private:
  KeptFiles files_;
  std::map<std::string, std::uint64_t, std::less<>> laid_out_;  ///< from programs to checksums
};

}  // namespace dermis::program
