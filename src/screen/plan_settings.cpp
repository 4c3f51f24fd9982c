#include "screen/plan_settings.hpp"

#include <algorithm>

#include "opencl/device.hpp"
#include "screen/check_materials.hpp"
#include "screen/curvature.hpp"

namespace dermis {

bool PlanSettings::has_pixel_width() const { return frames.mask || any_follows_albedo(materials); }

bool PlanSettings::is_sheared() const { return frames.depth && options.sheared && options.jitter == 0; }

bool PlanSettings::has_curvature() const {
  return options.curvature && frames.depth && frames.normal && !options.sums_weights &&
         std::any_of(materials.begin(), materials.end(),
                     [](const Material& its) { return dermis::has_curvature(its.profile); });
}

bool PlanSettings::item_is_pixel() const { return dermis::item_is_pixel(device); }

}  // namespace dermis
