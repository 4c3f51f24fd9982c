#include "stress/field.hpp"

#include <cmath>

namespace dermis::bench {

double uniform(std::mt19937& engine, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

StressField stress_plane(std::mt19937& engine, int width_px, int height_px, double px_per_mm) {
  StressField field{.width_px = width_px,
                    .height_px = height_px,
                    .camera = Camera::orthographic(px_per_mm, px_per_mm * uniform(engine, 0.7, 1.4))};
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const double lit = (x / 9 + y / 5) % 3 != 0 ? 1 : 0.05;
      for (int c = 0; c < 3; ++c) field.light.push_back(static_cast<float>(lit * uniform(engine, 0.4, 1.5)));
    }
  }
  return field;
}

StressField stress_surface(std::mt19937& engine, int width_px, int height_px, double focal_px, double depth_units,
                           double bump_units) {
  StressField field = stress_plane(engine, width_px, height_px, 1);
  field.camera = Camera::perspective(focal_px, focal_px * uniform(engine, 0.8, 1.2),
                                     uniform(engine, 0.3, 0.7) * width_px, uniform(engine, 0.3, 0.7) * height_px);
  const double wave = uniform(engine, 0.1, 0.3);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const bool is_background = uniform(engine, 0, 60) < 1;
      const double bump = bump_units * std::sin(wave * x) * std::cos(0.7 * wave * y);
      field.depth.push_back(static_cast<float>(is_background ? 1e10 : depth_units + bump));
    }
  }
  return field;
}

}  // namespace dermis::bench
