/// PROFILE on the command line.
#pragma once

#include <string>
#include <string_view>

#include "dermis/profile.hpp"

namespace dermis::program {

/// The grammar of PROFILE, for help texts.
inline constexpr std::string_view profile_grammar =
    "PROFILE is one of\n"
    "  NAME                       a preset, see `dermis profiles`\n"
    "  burley:DR/DG/DB            Burley's diffusion, d = 1/s in mm per channel\n"
    "  burley:RR/RG/RB,cycles     Cycles' subsurface radius in mm, with the albedo of each pixel\n"
    "  burley:RR/RG/RB,cycles,albedo=AR/AG/AB\n"
    "                             the same with a constant albedo\n"
    "  gaussians:FILE.json        {\"terms\": [{\"variance_mm2\": v, \"weight\": [r, g, b]}, ...]}";

/// The profile that `text` describes; `argument` is named in errors. Throws Error(usage) if the text is malformed, and
/// Error(input_missing) or Error(input_unsupported) for the file of gaussians.
Profile parse_profile(std::string_view argument, std::string_view text);

/// The same text without the folders of the file in it.
std::string without_folders(std::string_view text);

}  // namespace dermis::program
