/// From scattered light to what a filter writes.
#pragma once

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

/// Fills a Reference. `after`: the light after the passes, of which a pixel takes the share that its material covers.
/// The beauty changes only where the surface is touched.
Reference recompose(const Surface& surface, const Light& light, const BoundedPicture& after);

}  // namespace dermis::oracle
