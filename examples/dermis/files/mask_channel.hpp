/// --mask-channel: the pixels where a channel has a value.
#pragma once

#include <string>
#include <string_view>

#include "dermis/exr.hpp"
#include "dermis/oracle/picture.hpp"

namespace dermis::program {

/// NAME=VALUE: 1 where the channel has the value, else 0. Throws Error(usage) for another form or if no pixel has it,
/// Error(role_missing) if there is no such channel; messages call the picture by its name.
oracle::Picture read_mask(const std::string& text, std::string_view name_of_picture, const exr::Picture& picture,
                          const exr::Window& window);

}  // namespace dermis::program
