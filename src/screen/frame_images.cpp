#include "screen/frame_images.hpp"

#include <cmath>

namespace dermis {

namespace {

void check_positive(double value, const char* argument) {
  // Kernels hold it, and its reciprocal, as float32.
  if (!(value >= 1e-18 && value <= 1e18)) {
    throw Error(ErrorCode::usage, argument, std::to_string(value), "1e-18..1e18");
  }
}

void check_camera(const Frame& frame) {
  check_positive(frame.mm_per_unit, "mm_per_unit");
  check_positive(frame.camera.scale_x, "camera scale_x");
  check_positive(frame.camera.scale_y, "camera scale_y");
  for (const double center : {frame.camera.center_x, frame.camera.center_y}) {
    if (!std::isfinite(center)) {
      throw Error(ErrorCode::usage, "camera center", std::to_string(center), "a finite number of pixels");
    }
  }
  if (frame.camera.projection == Camera::Projection::perspective && !frame.depth) {
    throw Error(ErrorCode::role_missing, "depth", "no image", "a depth image, or an orthographic camera");
  }
}

}  // namespace

std::array<CallerImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                 const Options& options) {
  check_size(frame.width, frame.height, "frame size");
  const std::array<CallerImage, image_count> images = {
      described("light", 3, frame.light, frame.width),         described("albedo", 3, frame.albedo, frame.width),
      described("depth", 1, frame.depth, frame.width),         described("material", 1, frame.material, frame.width),
      described("mask", 1, frame.mask, frame.width),           described("matte", 1, frame.matte, frame.width),
      described("normal", 3, frame.normal, frame.width),       described("beauty", 3, frame.beauty, frame.width),
      described("scattered", 3, frame.scattered, frame.width), described("result", 3, frame.result, frame.width)};
  const std::array<bool, image_count> wanted = {true,
                                                description.albedo,
                                                description.depth,
                                                description.material,
                                                description.mask,
                                                description.matte,
                                                description.normal,
                                                static_cast<bool>(frame.result),
                                                false,
                                                false};
  for (int i = 0; i < image_count; ++i) {
    const bool optional_extra = i == static_cast<int>(ImageName::beauty);
    if (wanted[i] && !images[i].present()) {
      throw Error(ErrorCode::role_missing, images[i].name, "no image", "an image, as the plan was made for one");
    }
    if (!wanted[i] && images[i].present() && !images[i].is_output && !optional_extra) {
      throw Error(ErrorCode::usage, images[i].name, "an image", "none, as the plan was made without");
    }
    check_image(images[i], frame.width, frame.height);
  }
  if (!frame.scattered && !frame.result) {
    throw Error(ErrorCode::usage, "outputs", "none", "a scattered or a result image");
  }
  if (frame.result && options.lighting == Lighting::raw && !frame.albedo) {
    throw Error(ErrorCode::role_missing, "albedo", "no image",
                "an albedo image, to put raw light back into the beauty");
  }
  check_camera(frame);
  return images;
}

const cl::Buffer& BoundImages::buffer(ImageName name) const {
  return ImageBuffers::buffer(static_cast<std::size_t>(has(name) ? name : ImageName::light));
}

params::ImageParams BoundImages::layout(ImageName name) const {
  return ImageBuffers::layout(static_cast<std::size_t>(name));
}

bool BoundImages::output_over(ImageName input) const {
  const auto at = static_cast<std::size_t>(input);
  return overlap(at, static_cast<std::size_t>(ImageName::scattered)) ||
         overlap(at, static_cast<std::size_t>(ImageName::result));
}

bool BoundImages::in_place(ImageName output, ImageName input) const {
  return same_place(static_cast<std::size_t>(output), static_cast<std::size_t>(input));
}

}  // namespace dermis
