#include "program/made_picture.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "dermis/oracle/compare.hpp"
#include "program/run_program.hpp"
#include "support/catch.hpp"

using dermis::exr::Picture;

MadeScene make_scene(const std::string& path, const std::string& name, int width, int height, double px_per_mm,
                     bool orthographic) {
  std::vector<std::string> arguments = {"scene",       name,
                                        "-o",          path,
                                        "--size",      std::to_string(width) + "x" + std::to_string(height),
                                        "--px-per-mm", std::to_string(px_per_mm)};
  if (orthographic) arguments.emplace_back("--orthographic");
  const std::string output = run_well(arguments);
  const std::string key = orthographic ? "px_per_unit=" : "focal_px=";
  REQUIRE(output.starts_with(key));
  const std::string value = output.substr(key.size(), output.find('\n') - key.size());
  return {path, {orthographic ? "--px-per-unit" : "--focal-px", value, "--mm-per-unit", "1"}};
}

std::vector<std::string> filter_arguments(const MadeScene& scene, const std::string& output,
                                          const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"filter", scene.path, "-o", output};
  arguments.insert(arguments.end(), scene.camera.begin(), scene.camera.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

PictureCopy::PictureCopy(const std::string& path) {
  const Picture picture = Picture::read(path);
  data_ = picture.data_window();
  display_ = picture.display_window();
  for (const auto& channel : picture.channels()) planes_.push_back({channel.name, picture.plane(channel.name)});
}

PictureCopy& PictureCopy::without(const std::string& prefix) {
  const auto gone = [&](const Plane& plane) { return plane.name.starts_with(prefix); };
  REQUIRE(std::erase_if(planes_, gone) > 0);
  return *this;
}

PictureCopy& PictureCopy::with_layer(const std::string& prefix) {
  const std::string layer = "ViewLayer.";
  const std::vector<Plane> planes = planes_;
  for (const Plane& plane : planes)
    if (plane.name.starts_with(layer)) planes_.push_back({prefix + plane.name.substr(layer.size()), plane.values});
  return *this;
}

PictureCopy& PictureCopy::with(const std::string& channel, const std::vector<float>& values) {
  std::erase_if(planes_, [&](const Plane& plane) { return plane.name == channel; });
  planes_.push_back({channel, values});
  return *this;
}

PictureCopy& PictureCopy::attribute(const std::string& name, const std::string& value) {
  attributes_.emplace_back(name, value);
  return *this;
}

void PictureCopy::write(const std::string& path) const {
  Picture picture(data_, display_);
  for (const Plane& plane : planes_) picture.add_channels(std::span(&plane.name, 1), dermis::Format::f32);
  for (const Plane& plane : planes_) {
    const dermis::OutputImage view = picture.view_to_write(std::span(&plane.name, 1));
    auto* const first = static_cast<std::byte*>(view.host) + view.layout.offset;
    for (int y = 0; y < data_.height; ++y) {
      for (int x = 0; x < data_.width; ++x) {
        const float& value = plane.values[static_cast<std::size_t>(y) * data_.width + x];
        std::memcpy(first + y * view.layout.row_stride + x * view.layout.pixel_stride, &value, sizeof(float));
      }
    }
  }
  for (const auto& [name, value] : attributes_) picture.set_attribute(name, value);
  picture.write(path);
}

std::vector<std::vector<std::byte>> bits_of(const Picture& picture, const std::string& channel) {
  const dermis::Image view = picture.view(std::span(&channel, 1));
  const auto* const first = static_cast<const std::byte*>(view.host) + view.layout.offset;
  std::vector<std::vector<std::byte>> bits;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const std::byte* value = first + y * view.layout.row_stride + x * view.layout.pixel_stride;
      bits.emplace_back(value, value + dermis::bytes_of(view.layout.format));
    }
  }
  return bits;
}

bool is_identical(const std::string& a, const std::string& b) {
  const Picture picture_a = Picture::read(a);
  const Picture picture_b = Picture::read(b);
  if (picture_a.channels().size() != picture_b.channels().size()) return false;
  for (const auto& channel : picture_a.channels()) {
    if (picture_b.find(channel.name) == nullptr) return false;
    if (bits_of(picture_a, channel.name) != bits_of(picture_b, channel.name)) return false;
  }
  return true;
}

namespace {

dermis::oracle::Picture rgb_of(const std::string& path, const std::string& prefix) {
  const Picture picture = Picture::read(path);
  dermis::oracle::Picture rgb(picture.width(), picture.height(), 3);
  const char* const names[] = {".R", ".G", ".B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> plane = picture.plane(prefix + names[c]);
    for (std::size_t i = 0; i < plane.size(); ++i) rgb.values[i * 3 + c] = plane[i];
  }
  return rgb;
}

}  // namespace

double relative_l2(const std::string& a, const std::string& b, const std::string& prefix) {
  return dermis::oracle::compare(rgb_of(a, prefix), rgb_of(b, prefix)).relative_l2;
}
