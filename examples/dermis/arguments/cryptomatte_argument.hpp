/// --cryptomatte: material ids and mattes from the names of objects.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

void add_cryptomatte_argument(CLI::App& app, std::vector<std::string>& arguments);

/// The arguments NAME=ID give each pixel two values: its id, 0 or another that is not named where there is none, and
/// the share that it covers. Throws Error(usage) for what is malformed, and as exr::load_cryptomatte.
struct NamedMattes {
  std::vector<float> ids, shares;
};
NamedMattes load_named_mattes(const exr::Picture& picture, const std::vector<std::string>& arguments);

}  // namespace dermis::program
