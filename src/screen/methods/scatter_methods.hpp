// All methods. The class of each is in the file of its own that makes it.
#pragma once

#include <memory>

#include "screen/methods/scatter_method.hpp"

namespace dermis {

std::unique_ptr<ScatterMethod> make_separable_tiles(const PlanSettings& settings);
std::unique_ptr<ScatterMethod> make_separable_pixels(const PlanSettings& settings);
std::unique_ptr<ScatterMethod> make_surface_integral(const PlanSettings& settings);
std::unique_ptr<ScatterMethod> make_disc_sampling(const PlanSettings& settings);

/// The method that the options ask for, on the device. It refers to the settings.
inline std::unique_ptr<ScatterMethod> make_scatter_method(const PlanSettings& settings) {
  switch (settings.options.method) {
    case Method::exact:
      return make_surface_integral(settings);
    case Method::disc:
      return make_disc_sampling(settings);
    case Method::separable:
      break;
  }
  return settings.item_is_pixel() ? make_separable_pixels(settings) : make_separable_tiles(settings);
}

}  // namespace dermis
