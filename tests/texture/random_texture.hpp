// Random textures: charts of any shape, bumpy stretches, any format and strides.
#pragma once

#include <optional>

#include "dermis/texture.hpp"
#include "support/guarded_image.hpp"

/// The properties of a random texture that a test sets.
struct RandomTextureChoice {
  int width;
  int height;
  dermis::TextureMethod method;
  bool with_gaps = true;            ///< random strides
  std::optional<bool> charts = {};  ///< whether there is a mask
  std::optional<bool> stretch = {};
  std::optional<bool> albedo = {};
};

/// A texture, its memory, and the arguments of a plan for it.
struct RandomTexture {
  int width, height;
  dermis::Profile profile;
  dermis::TextureOptions options;
  double mm_per_texel;
  std::optional<GuardedImage> light, albedo, mask, stretch_u, stretch_v, scattered, result;

  RandomTexture(Random& random, const RandomTextureChoice& choice);

  dermis::TextureFrame frame();
};
