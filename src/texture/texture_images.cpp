#include "texture/texture_images.hpp"

#include <string>

namespace dermis {

std::array<CallerImage, texture_image_count> check_texture(const TextureFrame& frame,
                                                           const TextureDescription& description) {
  check_size(frame.width, frame.height, "texture size");
  const int width = frame.width;
  const std::array<CallerImage, texture_image_count> images = {
      described("light", 3, frame.light, width),         described("albedo", 3, frame.albedo, width),
      described("mask", 1, frame.mask, width),           described("stretch_u", 1, frame.stretch_u, width),
      described("stretch_v", 1, frame.stretch_v, width), described("scattered", 3, frame.scattered, width),
      described("result", 3, frame.result, width)};
  const std::array<bool, texture_image_count> wanted = {
      true, description.albedo, description.mask, description.stretch, description.stretch, false, false};
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (wanted[i] && !images[i].present()) {
      throw Error(ErrorCode::role_missing, images[i].name, "no image", "an image, as the plan was made for one");
    }
    if (!wanted[i] && images[i].present() && !images[i].is_output) {
      throw Error(ErrorCode::usage, images[i].name, "an image", "none, as the plan was made without");
    }
    check_image(images[i], frame.width, frame.height);
  }
  if (!frame.scattered && !frame.result) {
    throw Error(ErrorCode::usage, "outputs", "none", "a scattered or a result image");
  }
  if (frame.result && !frame.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image", "an albedo image, to put it back into the result");
  }
  if (!description.stretch && !(frame.mm_per_texel >= 1e-9 && frame.mm_per_texel <= 1e9)) {
    throw Error(ErrorCode::usage, "mm_per_texel", std::to_string(frame.mm_per_texel), "1e-9..1e9");
  }
  return images;
}

TextureBuffers::TextureBuffers(const Device& device, const cl::CommandQueue& queue, const TextureFrame& frame,
                               const std::array<CallerImage, texture_image_count>& images)
    : ImageBuffers(device, queue, frame.width, frame.height, images) {
  const auto layout_of = [&](TextureImage image) { return layout(static_cast<std::size_t>(image)); };
  layouts_ = {layout_of(TextureImage::light),     layout_of(TextureImage::albedo),
              layout_of(TextureImage::mask),      layout_of(TextureImage::stretch_u),
              layout_of(TextureImage::stretch_v), layout_of(TextureImage::scattered),
              layout_of(TextureImage::result)};
  for (std::size_t output = 0; output < images.size(); ++output) {
    if (!images[output].is_output) continue;
    for (std::size_t other = 0; other < output; ++other) {
      const bool both_written = images[other].is_output;
      if (overlap(output, other) && (both_written || !same_place(output, other))) {
        throw Error(ErrorCode::usage, images[output].name, std::string("memory of ") + images[other].name,
                    both_written ? "memory of its own" : "memory of its own, or just the place of an input");
      }
    }
  }
}

const cl::Buffer& TextureBuffers::buffer(TextureImage image) const {
  return ImageBuffers::buffer(static_cast<std::size_t>(has(image) ? image : TextureImage::light));
}

}  // namespace dermis
