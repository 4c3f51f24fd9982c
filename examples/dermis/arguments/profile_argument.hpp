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
    "  burley:LR/LG/LB,mfp,albedo=AR/AG/AB\n"
    "                             mean free path in mm and albedo\n"
    "  gaussians:FILE.json        {\"terms\": [{\"variance_mm2\": v, \"weight\": [r, g, b]}, ...]}\n"
    "  artist:NR/NG/NB,FR/FG/FB,w=W\n"
    "                             a near and a far Gaussian, standard deviations in mm, W of the light in the near "
    "one\n"
    "  dipole:SR/SG/SB,AR/AG/AB[,eta=E]\n"
    "                             a medium: reduced scattering and absorption in 1/mm, refractive index (1.3)\n"
    "  better-dipole:SR/SG/SB,AR/AG/AB[,eta=E]\n"
    "                             the same by d'Eon's better dipole\n"
    "  table:FILE.csv             rows of r_mm,R,G,B; a header line and # comments may stand in it";

/// The profile that `text` describes; `argument` is named in errors. Throws Error(usage) if the text is malformed, and
/// Error(input_missing) or Error(input_unsupported) for the file of Gaussians or of a table.
Profile parse_profile(std::string_view argument, std::string_view text);

/// The same text without the folders of the file in it.
std::string without_folders(std::string_view text);

}  // namespace dermis::program
