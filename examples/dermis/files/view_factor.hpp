/// What a renderer's diffuse passes have of the angle at which the camera looks, and light under a surface has not.
#pragma once

#include <vector>

#include "dermis/exr.hpp"
#include "dermis/words.hpp"

namespace dermis::program {

/// The factor 1 - (1 - cos)^5 / 2 that the Principled BSDF of Blender puts into its diffuse light, as its layer of
/// highlights takes the rest (Burley 2015, the retro-reflection without roughness).
enum class ViewFactor {
  automatic,   ///< principled for pictures of Blender, if light from behind or a random walk has to match a path tracer
  none,        ///< the light has no such factor
  principled,  ///< it is taken out
};

/// Takes the factor out of light, RGB, of a picture that a camera has seen. Throws Error(role_missing) if the picture
/// has no normals, or it is not known where the camera is.
void take_out_view_factor(const exr::Picture& picture, const exr::Roles& roles, const exr::FoundCamera& camera,
                          std::vector<float>& light);

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::ViewFactor>, 3>
    dermis::word_table<dermis::program::ViewFactor> = {{{dermis::program::ViewFactor::automatic, "auto"},
                                                        {dermis::program::ViewFactor::none, "none"},
                                                        {dermis::program::ViewFactor::principled, "principled"}}};
