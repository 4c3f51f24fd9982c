/// PROFILE on the command line.
#pragma once

#include <string>
#include <string_view>

#include "dermis/profile.hpp"

namespace dermis::program {

/// The grammar of PROFILE, for help texts.
std::string profile_grammar();

/// The profile that `text` describes; `argument` is named in errors. Throws Error(usage) if the text is malformed, and
/// Error(input_missing) or Error(input_unsupported) for the file of Gaussians or of a table.
Profile parse_profile(std::string_view argument, std::string_view text);

/// The file that a PROFILE names; empty if it names none.
std::string file_of_profile(std::string_view text);

/// `text` without the folders of the file in it.
std::string without_folders(std::string_view text);

}  // namespace dermis::program
