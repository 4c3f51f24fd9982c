/// The names that the channels of several parts have in one picture.
#pragma once

#include <string>
#include <vector>

#include "exr/image_library.hpp"

namespace dermis::exr {

/// The names of all channels of all parts, part by part, each once. A channel without a dot is called after its part
/// ("R" of "DiffDir" is "DiffDir.R"), and one of a part that has a view by it, as in files of one part
/// ("DiffDir.left.R"). Where two would have one name both are called after their parts.
/// Throws std::runtime_error if that does not tell them apart.
std::vector<std::vector<std::string>> names_in_picture(const std::vector<PartDescription>& parts);

}  // namespace dermis::exr
