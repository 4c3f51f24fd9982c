#include "screen/methods/scatter_method.hpp"

#include "screen/frame_run.hpp"

namespace dermis {

TapsDesign ScatterMethod::design_of(const Material& material) const {
  return material.taps.value_or(settings_.options.taps);
}

int ScatterMethod::most_terms() const {
  return dermis::most_terms(settings_, [&](const Material& m) { return design_of(m); });
}

int ScatterMethod::vector_width() const { return settings_.item_is_pixel() ? 1 : settings_.device.info().vector_width; }

void ScatterMethod::finish(FrameRun& run) const { run.write_deferred(); }

}  // namespace dermis
