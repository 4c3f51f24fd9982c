/// Names of passes that mean the same whoever writes them.
#pragma once

#include "dermis/exr.hpp"

namespace dermis::exr {

/// What a renderer's own table does not say; not light, albedo and ids, whose meaning differs.
extern const Renderer any_renderer;

}  // namespace dermis::exr
