#include "arguments/profile_argument.hpp"

#include <filesystem>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/profile_text.hpp"
#include "exr/message_text.hpp"
#include "files/gaussian_file.hpp"
#include "files/table_file.hpp"

namespace dermis::program {
namespace {

Profile parse_gaussians(const ProfileText& text) {
  return Profile::gaussians(read_gaussians(text.argument, std::string(text.rest())));
}

Profile parse_table(const ProfileText& text) {
  return Profile::tabulated(read_table(text.argument, std::string(text.rest())));
}

/// Those of the library, and files.
const std::vector<ProfileKind>& all_kinds() {
  static const std::vector<ProfileKind> all = [] {
    std::vector<ProfileKind> kinds(profile_kinds().begin(), profile_kinds().end());
    kinds.push_back(
        {"gaussians:", parse_gaussians, true, "gaussians:FILE.json",
         "  gaussians:FILE.json        {\"terms\": [{\"variance_mm2\": v, \"weight\": [r, g, b]}, ...]}\n"});
    kinds.push_back(
        {"table:", parse_table, true, "table:FILE.csv",
         "  table:FILE.csv             rows of r_mm,R,G,B; a header line and # comments may stand in it\n"});
    return kinds;
  }();
  return all;
}

}  // namespace

std::string profile_grammar() {
  std::string grammar = "PROFILE is one of\n  NAME                       a preset, see `dermis profiles`\n";
  for (const ProfileKind& kind : all_kinds()) grammar += kind.help;
  grammar.pop_back();
  return grammar;
}

Profile parse_profile(std::string_view argument, std::string_view text) {
  try {
    return dermis::parse_profile(argument, text, all_kinds());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::usage) throw;  // about a file, which is shown
    throw Error(error.code(), error.argument(), exr::shown(error.seen()), error.wanted());
  }
}

std::string file_of_profile(std::string_view text) {
  const ProfileKind* kind = kind_of(text, all_kinds());
  return kind != nullptr && kind->is_file ? std::string(text.substr(kind->prefix.size())) : std::string();
}

std::string without_folders(std::string_view text) {
  const std::string file = file_of_profile(text);
  if (file.empty()) return std::string(text);
  return std::string(text.substr(0, text.size() - file.size())) + std::filesystem::path(file).filename().string();
}

}  // namespace dermis::program
