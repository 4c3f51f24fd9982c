// A plane parallel to the screen, under light of equal channels and an orthographic camera.
#pragma once

#include <vector>

#include "dermis/plan.hpp"

struct Card {
  int width, height;
  double px_per_mm;
  std::vector<double> light;

  double at(int x, int y) const { return light[static_cast<std::size_t>(y) * width + x]; }

  /// Returns the light after scattering: one value per pixel and channel.
  std::vector<float> filtered(const dermis::Device& device, const dermis::Profile& profile,
                              const dermis::Options& options) const {
    std::vector<float> rgb, scattered(light.size() * 3);
    for (const double value : light) rgb.insert(rgb.end(), 3, static_cast<float>(value));
    dermis::Frame frame{.width = width,
                        .height = height,
                        .light = {.host = rgb.data()},
                        .camera = dermis::Camera::orthographic(px_per_mm, px_per_mm)};
    frame.scattered.host = scattered.data();
    dermis::Plan(device, {{0, profile}}, dermis::FrameDescription::of(frame), options).run(frame);
    return scattered;
  }
};
