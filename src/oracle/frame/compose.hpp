/// Composes the outputs of a filter from the scattered light.
#pragma once

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

/// Returns the outputs that a filter should have written. A pixel takes the share of `after`, the light after
/// scattering, that its material covers. The beauty changes only where pixels take light.
Reference compose(const Surface& surface, const Light& light, const BoundedPicture& after);

}  // namespace dermis::oracle
