#include "core/frame_images.hpp"

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

std::array<FrameImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                const Options& options) {
  check_size("frame size", frame.width, frame.height);
  const std::array<FrameImage, image_count> images = {
      describe("light", 3, frame.light, frame.width),         describe("albedo", 3, frame.albedo, frame.width),
      describe("depth", 1, frame.depth, frame.width),         describe("material", 1, frame.material, frame.width),
      describe("mask", 1, frame.mask, frame.width),           describe("beauty", 3, frame.beauty, frame.width),
      describe("scattered", 3, frame.scattered, frame.width), describe("result", 3, frame.result, frame.width)};
  const std::array<bool, image_count> described = {true,
                                                   description.albedo,
                                                   description.depth,
                                                   description.material,
                                                   description.mask,
                                                   static_cast<bool>(frame.result),
                                                   false,
                                                   false};
  for (int i = 0; i < image_count; ++i) {
    const bool optional_extra = i == static_cast<int>(ImageName::beauty);
    if (described[i] && !images[i].present()) {
      throw Error(ErrorCode::role_missing, images[i].name, "no image", "an image, as the plan was made for one");
    }
    if (!described[i] && images[i].present() && !images[i].is_output && !optional_extra) {
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

BoundImages::BoundImages(const cl::Context& context, const Frame& frame,
                         const std::array<FrameImage, image_count>& images)
    : memory_(context, frame.width, frame.height, images) {}

const cl::Buffer& BoundImages::buffer(ImageName name) const {
  return memory_.buffer(static_cast<int>(has(name) ? name : ImageName::light));
}

bool BoundImages::output_over(ImageName input) const {
  return memory_.overlap(static_cast<int>(input), static_cast<int>(ImageName::scattered)) ||
         memory_.overlap(static_cast<int>(input), static_cast<int>(ImageName::result));
}

}  // namespace dermis
