/// What a renderer's diffuse passes have of the angle at which the camera looks, and light under a surface has not.
#pragma once

#include <array>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "dermis/words.hpp"
#include "files/loaded_frame.hpp"

namespace dermis::program {

/// The factor 1 - (1 - cos)^5 / 2 that the Principled BSDF of Blender puts into its diffuse light, as its layer of
/// highlights takes the rest (Burley 2015: that of a Lambertian lobe, for the direction of view).
enum class ViewFactor {
  automatic,   ///< principled for pictures of Blender with views
  none,        ///< the light has no such factor
  principled,  ///< it is taken out
};

/// The factor of each pixel of a picture that a camera has seen; 1 where the picture does not tell. Throws
/// Error(role_missing) if it has no normals, or it is not known where the camera is.
std::vector<float> view_factors(const exr::Picture& picture, const exr::Roles& roles, const exr::FoundCamera& camera);

/// Takes the factors out of light, RGB.
void take_out(const std::vector<float>& factors, std::vector<float>& light);

/// Gives the beauty what its diffuse light has gained when the factors were taken out of it, so that the filter, which
/// replaces that light, leaves nothing of the gain.
void add_gain(const std::vector<float>& factors, const LoadedFrame& loaded, Lighting lighting,
              std::vector<float>& beauty);

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::ViewFactor>, 3>
    dermis::word_table<dermis::program::ViewFactor> = {{{dermis::program::ViewFactor::automatic, "auto"},
                                                        {dermis::program::ViewFactor::none, "none"},
                                                        {dermis::program::ViewFactor::principled, "principled"}}};
