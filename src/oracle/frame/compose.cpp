#include "oracle/frame/compose.hpp"

#include <cmath>
#include <utility>

namespace dermis::oracle {

namespace {

BoundedPicture result(const Surface& surface, const Light& light, const BoundedPicture& scattered) {
  BoundedPicture result(surface.width(), surface.height());
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfacePixel& pixel = surface.at(x, y);
      for (int c = 0; c < 3; ++c) {
        const Bounded before = light.beauty(x, y, c);
        const Bounded after = light.composed(x, y, c, scattered.at(x, y, c));
        Bounded value = pixel.takes_light() ? after : before;
        if (pixel.takes_light_unsure()) value.error = std::abs(after.value - before.value) + after.error;
        result.set(x, y, c, value);
      }
    }
  }
  return result;
}

/// Where the material covers only a part of a pixel, the rest keeps its light.
BoundedPicture blended(const Surface& surface, const Light& light, BoundedPicture scattered) {
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const SurfacePixel& pixel = surface.at(x, y);
      if (pixel.material < 0 || pixel.covered == 1 || !(pixel.takes_light() || pixel.takes_light_unsure())) continue;
      for (int c = 0; c < 3; ++c) {
        const Bounded before = light.filtered(x, y, c);
        scattered.set(x, y, c, before + exact(pixel.covered) * (scattered.at(x, y, c) - before));
      }
    }
  }
  return scattered;
}

}  // namespace

Reference compose(const Surface& surface, const Light& light, const BoundedPicture& after) {
  const BoundedPicture scattered = blended(surface, light, after);
  Reference reference;
  reference.scattered = scattered.value;
  reference.scattered_bound = scattered.error;
  reference.touched = surface.touched();
  if (light.has_beauty()) {
    BoundedPicture picture = result(surface, light, scattered);
    reference.result = std::move(picture.value);
    reference.result_bound = std::move(picture.error);
  }
  return reference;
}

}  // namespace dermis::oracle
