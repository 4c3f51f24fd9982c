/// --cryptomatte: material ids and mattes from the names of objects.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

/// A name in a Cryptomatte, and the material id of what it covers.
struct MatteId {
  std::string name;
  int id;
};

void add_cryptomatte_argument(CLI::App& app, std::vector<std::string>& arguments);

/// The folder of a picture, in which the manifest of a Cryptomatte may lie.
inline std::filesystem::path folder_of(const std::string& path) { return std::filesystem::path(path).parent_path(); }

/// The arguments NAME=ID. Throws Error(usage) for what is malformed.
std::vector<MatteId> parse_mattes(const std::vector<std::string>& arguments);

/// Two values of each pixel: its id, 0 or another that is not named where there is none, and the share that it covers.
struct NamedMattes {
  std::string cryptomatte;
  std::vector<float> ids, shares;
};

/// Throws as exr::load_cryptomatte. A manifest may lie in `folder`.
NamedMattes load_named_mattes(const exr::Picture& picture, const exr::Roles& roles, const std::vector<MatteId>& mattes,
                              const std::filesystem::path& folder);

}  // namespace dermis::program
