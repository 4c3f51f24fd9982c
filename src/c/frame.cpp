#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "c/call.hpp"
#include "c/handles.hpp"

using dermis::Error;
using dermis::ErrorCode;
using dermis::Frame;
using dermis::Image;
using dermis::Layout;
using dermis::OutputImage;
using dermis::c::call;
using dermis::c::require;

namespace {

struct NamedImage {
  const char* name;
  Image Frame::*image;
};

/// But for the position, which only a view has.
constexpr std::array images = {NamedImage{"light", &Frame::light},   NamedImage{"albedo", &Frame::albedo},
                               NamedImage{"depth", &Frame::depth},   NamedImage{"material", &Frame::material},
                               NamedImage{"mask", &Frame::mask},     NamedImage{"matte", &Frame::matte},
                               NamedImage{"normal", &Frame::normal}, NamedImage{"beauty", &Frame::beauty}};

struct NamedOutput {
  const char* name;
  OutputImage Frame::*image;
};

constexpr std::array outputs = {NamedOutput{"scattered", &Frame::scattered}, NamedOutput{"result", &Frame::result}};

Image* find_image(dermis_frame& frame, const char* name) {
  for (const NamedImage& named : images) {
    if (std::strcmp(named.name, name) == 0) return &(frame.frame.*named.image);
  }
  return std::strcmp(name, "position") == 0 ? &frame.position : nullptr;
}

OutputImage* find_output(dermis_frame& frame, const char* name) {
  for (const NamedOutput& named : outputs) {
    if (std::strcmp(named.name, name) == 0) return &(frame.frame.*named.image);
  }
  return nullptr;
}

[[noreturn]] void refuse_name(const char* name, bool is_read, bool is_written) {
  std::string names;
  const auto add = [&](const char* more) { names += (names.empty() ? "" : ", ") + std::string(more); };
  if (is_read) {
    for (const NamedImage& named : images) add(named.name);
    add("position");
  }
  if (is_written) {
    for (const NamedOutput& named : outputs) add(named.name);
  }
  throw Error(ErrorCode::usage, "name", name, names);
}

Layout layout_of(const dermis_layout* layout) {
  if (layout == nullptr) return {};
  if (layout->format < DERMIS_F16 || layout->format > DERMIS_U32) {
    throw Error(ErrorCode::usage, "format", std::to_string(layout->format), "a dermis_format");
  }
  return {static_cast<dermis::Format>(layout->format), layout->channel_stride, layout->pixel_stride, layout->row_stride,
          layout->offset};
}

}  // namespace

dermis_code dermis_frame_create(int width, int height, dermis_frame** frame) {
  return call([&] {
    require(frame, "frame");
    *frame = new dermis_frame{};
    (*frame)->frame.width = width;
    (*frame)->frame.height = height;
  });
}

dermis_code dermis_frame_set_image(dermis_frame* frame, const char* name, const void* pixels,
                                   const dermis_layout* layout) {
  return call([&] {
    require(frame, "frame");
    require(name, "name");
    Image* image = find_image(*frame, name);
    if (image == nullptr) refuse_name(name, true, false);
    *image = {.host = pixels, .layout = layout_of(layout)};
  });
}

dermis_code dermis_frame_set_output(dermis_frame* frame, const char* name, void* pixels, const dermis_layout* layout) {
  return call([&] {
    require(frame, "frame");
    require(name, "name");
    OutputImage* image = find_output(*frame, name);
    if (image == nullptr) refuse_name(name, false, true);
    *image = {.host = pixels, .layout = layout_of(layout)};
  });
}

dermis_code dermis_frame_set_buffer(dermis_frame* frame, const char* name, cl_mem buffer, const dermis_layout* layout) {
  return call([&] {
    require(frame, "frame");
    require(name, "name");
    if (Image* image = find_image(*frame, name)) {
      *image = {.buffer = buffer, .layout = layout_of(layout)};
    } else if (OutputImage* output = find_output(*frame, name)) {
      *output = {.buffer = buffer, .layout = layout_of(layout)};
    } else {
      refuse_name(name, true, true);
    }
  });
}

dermis_code dermis_frame_set_perspective(dermis_frame* frame, double focal_x_px, double focal_y_px, double center_x_px,
                                         double center_y_px) {
  return call([&] {
    require(frame, "frame");
    frame->frame.camera = dermis::Camera::perspective(focal_x_px, focal_y_px, center_x_px, center_y_px);
  });
}

dermis_code dermis_frame_set_orthographic(dermis_frame* frame, double px_per_unit_x, double px_per_unit_y) {
  return call([&] {
    require(frame, "frame");
    frame->frame.camera = dermis::Camera::orthographic(px_per_unit_x, px_per_unit_y);
  });
}

dermis_code dermis_frame_set_mm_per_unit(dermis_frame* frame, double mm_per_unit) {
  return call([&] {
    require(frame, "frame");
    frame->frame.mm_per_unit = mm_per_unit;
  });
}

dermis_code dermis_frame_add_view(dermis_frame* frame, const dermis_frame* view, const double to_camera[12]) {
  return call([&] {
    require(frame, "frame");
    require(view, "view");
    require(to_camera, "to_camera");
    const Frame& its = view->frame;
    dermis::View added{its.width, its.height, its.light, its.albedo, view->position, its.normal, its.material};
    std::copy_n(to_camera, added.to_camera.size(), added.to_camera.begin());
    frame->views.push_back(added);
  });
}

void dermis_frame_release(dermis_frame* frame) { delete frame; }
