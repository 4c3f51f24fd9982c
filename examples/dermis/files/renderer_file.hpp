/// --preset: a renderer by its name, or a file with a studio's own names of passes.
#pragma once

#include <optional>
#include <string>

#include "dermis/exr.hpp"

namespace dermis::program {

/// The names in a JSON file, of
///   {"lighting": "lit", "roles": {"light": ["key", ["fill", "bounce"]], "albedo": "tex"}}
/// where a role is the sum of a list of passes, and a pass has a name, or several of which the first counts that is
/// there. None if `preset` is "auto", empty or a renderer that dermis knows. Throws Error(usage) for another word,
/// Error(input_missing) and Error(input_unsupported) for a file that is not there or says anything else.
std::optional<exr::Renderer> read_renderer(const std::string& preset);

}  // namespace dermis::program
