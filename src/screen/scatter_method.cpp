#include "screen/scatter_method.hpp"

#include "screen/disc_sampling.hpp"
#include "screen/frame_run.hpp"
#include "screen/separable_pixels.hpp"
#include "screen/separable_tiles.hpp"
#include "screen/surface_integral.hpp"

namespace dermis {

TapsDesign ScatterMethod::design_of(const Material& material) const {
  return material.taps.value_or(settings_.options.taps);
}

int ScatterMethod::most_terms() const {
  return dermis::most_terms(settings_.device, settings_.materials, [&](const Material& m) { return design_of(m); });
}

int ScatterMethod::vector_width() const { return settings_.item_is_pixel() ? 1 : settings_.device.info().vector_width; }

int ScatterMethod::steps(int) const { return 1; }

void ScatterMethod::finish(FrameRun& run) const { run.write_deferred(); }

std::unique_ptr<ScatterMethod> make_scatter_method(const PlanSettings& settings) {
  switch (settings.options.method) {
    case Method::exact:
      return std::make_unique<SurfaceIntegral>(settings);
    case Method::disc:
      return std::make_unique<DiscSampling>(settings);
    case Method::separable:
      break;
  }
  if (settings.item_is_pixel()) return std::make_unique<SeparablePixels>(settings);
  return std::make_unique<SeparableTiles>(settings);
}

}  // namespace dermis
