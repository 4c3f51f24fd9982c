// Frames to put the filter under stress with.
#pragma once

#include <random>
#include <vector>

#include "dermis/frame.hpp"

namespace dermis::bench {

/// One frame. A scene unit is `mm_per_unit` millimetres.
struct StressField {
  int width_px = 0;
  int height_px = 0;
  Camera camera;
  double mm_per_unit = 1;
  Format format = Format::f32;    ///< f32 or f16, of light and output
  std::vector<float> light = {};  ///< RGB; rounded to half if the format is f16
  std::vector<float> depth = {};  ///< scene units; none if empty
  std::vector<float> ids = {};    ///< material ids; none if empty

  std::size_t pixels() const { return static_cast<std::size_t>(width_px) * height_px; }
};

/// A plane parallel to the screen, lit by patches and noise in 0.02..1.5.
StressField stress_plane(std::mt19937& engine, int width_px, int height_px, double px_per_mm);

/// A bumpy surface `depth_units` away under a perspective camera, a sixtieth of it background; the bumps are
/// `bump_units` high.
StressField stress_surface(std::mt19937& engine, int width_px, int height_px, double focal_px, double depth_units,
                           double bump_units);

double uniform(std::mt19937& engine, double low, double high);

}  // namespace dermis::bench
