#include "screen/plan_settings.hpp"

#include "screen/check_materials.hpp"

namespace dermis {

bool PlanSettings::has_pixel_width() const { return frames.mask || any_follows_albedo(materials); }

bool PlanSettings::is_sheared() const { return frames.depth && options.sheared && options.jitter == 0; }

bool PlanSettings::item_is_pixel() const { return device.info().type == "GPU"; }

}  // namespace dermis
