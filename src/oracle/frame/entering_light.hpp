/// What the curvature of a surface does to the light that enters it.
#pragma once

#include <span>

#include "dermis/oracle/reference.hpp"
#include "oracle/frame/frame_images.hpp"
#include "oracle/frame/light.hpp"
#include "oracle/frame/surface.hpp"

namespace dermis::oracle {

/// Returns the share of the light falling on a half-space that comes back by 255 scatterings or fewer, if each leaves
/// `scattering_albedo` and light enters by the cosine law (Chandrasekhar 1960, sections 35 and 38).
double returned_light(double scattering_albedo);

/// Returns `light` times the gain of the curvature H where a material has a WalkMedium and the frame depth and normals
/// (Options::curvature), else as it is. H is (L G - 2 M F + N E) D / 2 (D^2 + (E G / 100)^2), D = E G - F^2, of the
/// changes P' and n' of points and unit normals along both axes: E, F, G the products of P', L, M, N those of n' and
/// P'. A change is the mean of those to both neighbours of the material, each weighted by the fourth power of the other
/// one's length, and H that of the 3 x 3 pixels about a pixel that show its material, where those without a normal have
/// 0. With b = mfp H, g = 1 / A - 1 of the light A that a plane returns, and w = 1.35 b (1 + 2.2 (1 - A)^2 b), the gain
/// is 1 + w / sqrt(1 + (w / g)^2) for b > 0, and 1 / (1 - 1.35 b) else.
BoundedPicture entering_light(const Surface& surface, const FrameImages& images, std::span<const Material> materials,
                              const Options& options, const BoundedPicture& light);

}  // namespace dermis::oracle
