#include "screen/methods/scatter_method.hpp"

#include <algorithm>

#include "screen/frame_run.hpp"

namespace dermis {

TapsDesign ScatterMethod::design_of(const Material& material) const {
  return material.taps.value_or(settings_.options.taps);
}

int ScatterMethod::most_terms() const {
  return dermis::most_terms(settings_, [&](const Material& m) { return design_of(m); });
}

int ScatterMethod::vector_width() const { return settings_.item_is_pixel() ? 1 : settings_.device.info().vector_width; }

int ScatterMethod::rows_at_once(const FrameSize& frame) const {
  constexpr int rows_of_cpus = 16;
  constexpr int items_of_unit = 2048;  // in flight in each compute unit of a GPU
  if (!settings_.item_is_pixel()) return rows_of_cpus;
  return parts_of(items_of_unit * std::max(1, settings_.device.info().compute_units), frame.width);
}

void ScatterMethod::finish(FrameRun& run) const { run.write_deferred(); }

}  // namespace dermis
