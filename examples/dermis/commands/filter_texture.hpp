/// dermis filter --space texture: light in a UV layout in, the same with scattered light out.
#pragma once

#include "arguments/filter_arguments.hpp"

namespace dermis::program {

/// Filters all inputs. Returns the exit code. Throws Error for what cannot be, before anything is written.
int filter_textures(const FilterArguments& arguments);

}  // namespace dermis::program
