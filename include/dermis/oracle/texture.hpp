/// Scattering in texture space in plain scalar double precision, to check the kernels against. It shares no code with
/// them.
#pragma once

#include "dermis/oracle/picture.hpp"
#include "dermis/texture.hpp"

namespace dermis::oracle {

/// The outputs that a TexturePlan should have written, and absolute bounds on how far each value of a float32 device
/// may be off.
struct TextureReference {
  Picture scattered;
  Picture scattered_bound;
  Picture result;  ///< empty if the frame has no albedo
  Picture result_bound;
  Picture object;  ///< 1 channel: 1 where a texel is not empty
};

/// Sums the taps of the chain texel by texel: see GaussianChain. Reads the frame's host images. The bounds hold for
/// outputs of float32.
TextureReference gaussian_chain(const TextureFrame& frame, const GaussianChain& chain, double albedo_mix);

/// Sums the exponentials without recursion: the light of each texel times the integral over it of the exponentials
/// between two mirrors, which is Green's function of (1 - (1 / gamma^2) d^2/dx^2) with no flux through the ends of the
/// run, for every pair of texels of a run.
TextureReference recursion(const TextureFrame& frame, const Recursion& recursion, double albedo_mix);

/// Returns the stretches along u and along v, mm, as channels: see dermis::stretch_of_positions. `position` has 3
/// channels, `mask` 1 or is empty.
Picture stretch_of_positions(const Picture& position, const Picture& mask, double mm_per_unit);

}  // namespace dermis::oracle
