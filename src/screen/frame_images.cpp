#include "screen/frame_images.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "opencl/program.hpp"

namespace dermis {

const std::array<FrameImage, image_count> frame_images = {{
    {"light", 3, &Frame::light, nullptr, nullptr, &params::FrameLayouts::light},
    {"albedo", 3, &Frame::albedo, nullptr, &FrameDescription::albedo, &params::FrameLayouts::albedo},
    {"depth", 1, &Frame::depth, nullptr, &FrameDescription::depth, &params::FrameLayouts::depth},
    {"material", 1, &Frame::material, nullptr, &FrameDescription::material, &params::FrameLayouts::material, true},
    {"mask", 1, &Frame::mask, nullptr, &FrameDescription::mask, &params::FrameLayouts::mask},
    {"matte", 1, &Frame::matte, nullptr, &FrameDescription::matte, &params::FrameLayouts::matte},
    {"normal", 3, &Frame::normal, nullptr, &FrameDescription::normal, &params::FrameLayouts::normal},
    {"beauty", 3, &Frame::beauty, nullptr, nullptr, &params::FrameLayouts::beauty},
    {"scattered", 3, nullptr, &Frame::scattered, nullptr, &params::FrameLayouts::scattered},
    {"result", 3, nullptr, &Frame::result, nullptr, &params::FrameLayouts::result},
}};

namespace {

constexpr std::size_t index_of(ImageName name) { return static_cast<std::size_t>(name); }

CallerImage image_of(const Frame& frame, const FrameImage& image) {
  return image.input != nullptr
             ? described(image.name, image.channels, frame.*image.input, frame.width, image.takes_integers)
             : described(image.name, image.channels, frame.*image.output, frame.width);
}

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

FrameDescription FrameDescription::of(const Frame& frame) {
  FrameDescription description;
  for (const FrameImage& image : frame_images) {
    if (image.described != nullptr) description.*image.described = static_cast<bool>(frame.*image.input);
  }
  description.views = !frame.views.empty();
  return description;
}

std::string image_constants(const FrameDescription& description) {
  std::string constants;
  for (const FrameImage& image : frame_images) {
    if (image.described == nullptr) continue;
    std::string name = image.name;
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    constants += build_constant(("HAS_" + name).c_str(), description.*image.described ? 1 : 0);
  }
  return constants;
}

Frame one_pixel_frame(const FrameDescription& description, const void* in, void* out) {
  Frame frame{.width = 1, .height = 1, .light = {.host = in}, .camera = Camera::orthographic(1, 1)};
  for (const FrameImage& image : frame_images) {
    if (image.described != nullptr && description.*image.described) frame.*image.input = {.host = in};
  }
  frame.scattered = {.host = out};
  return frame;
}

std::array<CallerImage, image_count> check_frame(const Frame& frame, const FrameDescription& description,
                                                 const Options& options) {
  check_size(frame.width, frame.height, "frame size");
  const std::array<CallerImage, image_count> images = images_of_frame(frame);
  for (std::size_t i = 0; i < image_count; ++i) {
    const FrameImage& image = frame_images[i];
    const bool is_described = image.described != nullptr;
    const bool is_needed = is_described ? description.*image.described
                                        : i == index_of(ImageName::light) ||
                                              (i == index_of(ImageName::beauty) && static_cast<bool>(frame.result));
    if (is_needed && !images[i].present()) {
      throw Error(ErrorCode::role_missing, image.name, "no image", "an image, as the plan was made for one");
    }
    if (is_described && !is_needed && images[i].present()) {
      throw Error(ErrorCode::usage, image.name, "an image", "none, as the plan was made without");
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

std::array<CallerImage, image_count> images_of_frame(const Frame& frame) {
  std::array<CallerImage, image_count> images;
  for (std::size_t i = 0; i < image_count; ++i) images[i] = image_of(frame, frame_images[i]);
  return images;
}

std::vector<cl::Buffer> BoundImages::buffers(std::initializer_list<ImageName> names) const {
  std::vector<cl::Buffer> buffers;
  for (const ImageName name : names) buffers.push_back(buffer(index_of(has(name) ? name : ImageName::light)));
  return buffers;
}

params::FrameLayouts BoundImages::layouts() const {
  params::FrameLayouts layouts{};
  for (std::size_t i = 0; i < image_count; ++i) layouts.*frame_images[i].layout = layout(i);
  return layouts;
}

bool BoundImages::output_over(ImageName input) const {
  return overlap(index_of(input), index_of(ImageName::scattered)) ||
         overlap(index_of(input), index_of(ImageName::result));
}

bool BoundImages::in_place(ImageName output, ImageName input) const {
  return same_place(index_of(output), index_of(input));
}

}  // namespace dermis
