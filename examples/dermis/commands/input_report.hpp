/// What a run of the filter took from a picture, said before it begins.
#pragma once

#include <cstdint>
#include <vector>

#include "commands/surface_input.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// The pixels that cannot take part, and why.
struct LeftOut {
  std::int64_t fractional_ids = 0;    ///< of the surface: ids that are no whole numbers
  std::int64_t background = 0;        ///< of a material, but with no depth
  std::int64_t inner_background = 0;  ///< of these: amid such pixels
  std::int64_t bad_light = 0;         ///< not finite
  std::int64_t bad_albedo = 0;
  std::int64_t bad_depth = 0;  ///< not a number
  std::int64_t bad_beauty = 0;
};

LeftOut count_left_out(const SurfaceInput& input, const SurfaceRequest& request);

/// Warns of what contradicts roles and camera.
void warn_of_input(const exr::Roles& roles, const exr::FoundCamera& camera, Messages& messages);

/// Says which channels play which role and by which rule, where the camera comes from, how large each material and its
/// kernel are on the picture, and what was left out. Warns of what looks wrong: kernels that are smaller than half a
/// pixel or larger than the picture, a material that is all background, light that is taken for raw though nothing says
/// so.
void report_input(const SurfaceInput& input, const SurfaceRequest& request, const std::vector<MaterialPixels>& pixels,
                  const LeftOut& left_out, Messages& messages);

}  // namespace dermis::program
