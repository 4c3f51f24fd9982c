// The images of a texture, checked.
#pragma once

#include <array>
#include <cstddef>

#include "dermis/texture.hpp"
#include "opencl/image_buffers.hpp"

namespace dermis {

enum class TextureImage : std::size_t { light, albedo, mask, stretch_u, stretch_v, scattered, result };
inline constexpr std::size_t texture_image_count = 7;

/// Checks the frame against the plan's description and returns its images, indexed by TextureImage. Throws
/// Error(usage), or Error(role_missing) if an image is not there that the description has or the result needs.
std::array<CallerImage, texture_image_count> check_texture(const TextureFrame& frame,
                                                           const TextureDescription& description);

/// The buffers of a texture's images.
class TextureBuffers : public ImageBuffers {
 public:
  /// Throws Error(usage) if an output lies over an input, but not in its place.
  TextureBuffers(const Device& device, const cl::CommandQueue& queue, const TextureFrame& frame,
                 const std::array<CallerImage, texture_image_count>& images);

  bool has(TextureImage image) const { return ImageBuffers::has(static_cast<std::size_t>(image)); }

  /// The buffer of an image; of the light if the frame has no such image, so that kernels always get a valid argument.
  const cl::Buffer& buffer(TextureImage image) const;
  /// The layouts of all images.
  const params::TextureLayouts& layouts() const { return layouts_; }

 private:
  params::TextureLayouts layouts_;
};

}  // namespace dermis
