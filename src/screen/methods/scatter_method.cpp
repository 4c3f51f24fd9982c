#include "screen/methods/scatter_method.hpp"

#include <algorithm>
#include <cmath>

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

double ScatterMethod::longest_ray(const Camera& camera, const FrameSize& frame) {
  if (camera.projection != Camera::Projection::perspective) return 1;
  const auto farthest = [](double center, double size, double scale) {
    return std::max(std::abs(center), std::abs(size - center)) / scale;
  };
  return std::hypot(1, farthest(camera.center_x, frame.width, camera.scale_x),
                    farthest(camera.center_y, frame.height, camera.scale_y));
}

int ScatterMethod::rows_within(double rows, const FrameSize& frame) {
  return rows < frame.height ? static_cast<int>(std::ceil(rows)) : frame.height;
}

void ScatterMethod::finish(FrameRun& run) const { run.write_deferred(); }

}  // namespace dermis
