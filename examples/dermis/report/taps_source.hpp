/// Taps as source code.
#pragma once

#include <array>
#include <string>

#include "dermis/words.hpp"
#include "report/taps_report.hpp"

namespace dermis::program {

enum class Language { c, glsl, hlsl };

/// Arrays of offsets, scales and weights, with a comment on how to use them. Numbers have the digits that restore them.
std::string source_of(const TapsReport& report, Language language);

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::Language>, 3> dermis::word_table<dermis::program::Language> =
    {{{program::Language::c, "c"}, {program::Language::glsl, "glsl"}, {program::Language::hlsl, "hlsl"}}};
