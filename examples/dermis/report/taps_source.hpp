/// Taps as source code.
#pragma once

#include <string>
#include <string_view>

#include "report/taps_report.hpp"

namespace dermis::program {

/// Arrays of offsets, scales and weights, with a comment on how to use them; `language` is c, glsl or hlsl.
/// Numbers have the digits that restore them.
std::string source_of(const TapsReport& report, std::string_view language);

}  // namespace dermis::program
