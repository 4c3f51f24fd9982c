/// Scattering in texture space again, in plain scalar double precision. Shares no code with the kernels.
#pragma once

#include "dermis/oracle/picture.hpp"
#include "dermis/texture.hpp"

namespace dermis::oracle {

/// What a TexturePlan should have written, and how far a float32 device may be off, absolute, per value.
struct TextureReference {
  Picture scattered;
  Picture scattered_bound;
  Picture result;  ///< empty if the frame has no albedo
  Picture result_bound;
  Picture object;  ///< 1 channel: 1 where a texel is not empty
};

/// The same taps, summed texel by texel: see GaussianChain. Reads the frame's host images. The bounds hold for outputs
/// of float32.
TextureReference gaussian_chain(const TextureFrame& frame, const GaussianChain& chain, double albedo_mix);

/// The same exponentials, not by recursion: the light of each texel times the integral over it of the exponentials
/// between two mirrors, which is Green's function of (1 - (1 / gamma^2) d^2/dx^2) with no flux through the ends of the
/// run, for every pair of texels of a run.
TextureReference recursion(const TextureFrame& frame, const Recursion& recursion, double albedo_mix);

/// Stretches along u and along v, mm, as channels: see dermis::stretch_of_positions. `position` has 3 channels, `mask`
/// 1 or is empty.
Picture stretch_of_positions(const Picture& position, const Picture& mask, double mm_per_unit);

}  // namespace dermis::oracle
