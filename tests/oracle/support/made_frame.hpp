// Frames whose images a test fills in by hand.
#pragma once

#include <vector>

#include "dermis/frame.hpp"

/// Packed float images; those that stay empty are not in the frame.
struct MadeFrame {
  int width;
  int height;
  dermis::Camera camera;
  double mm_per_unit = 1;
  std::vector<float> light, albedo, depth, material, mask, matte, beauty;

  /// Has constant light and no other image.
  MadeFrame(int width_px, int height_px, const dermis::Camera& camera_, float light_value = 1)
      : width(width_px), height(height_px), camera(camera_), light(3 * pixels(), light_value) {}

  std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }

  static void set_rgb(std::vector<float>& image, std::size_t pixel, float r, float g, float b) {
    image[3 * pixel] = r;
    image[3 * pixel + 1] = g;
    image[3 * pixel + 2] = b;
  }

  dermis::Frame frame() const {
    dermis::Frame frame;
    frame.width = width;
    frame.height = height;
    frame.camera = camera;
    frame.mm_per_unit = mm_per_unit;
    const auto image = [](const std::vector<float>& values) {
      return values.empty() ? dermis::Image{} : dermis::Image{.host = values.data()};
    };
    frame.light = image(light);
    frame.albedo = image(albedo);
    frame.depth = image(depth);
    frame.material = image(material);
    frame.mask = image(mask);
    frame.matte = image(matte);
    frame.beauty = image(beauty);
    return frame;
  }
};
