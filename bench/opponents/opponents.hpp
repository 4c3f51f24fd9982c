// Makes the opponent that a case names.
#pragma once

#include <memory>
#include <vector>

#include "dermis/device.hpp"
#include "measure/case.hpp"
#include "measure/scene.hpp"
#include "opponents/opponent.hpp"

namespace dermis::bench {

/// Weights per channel of a symmetric pass, and where they lie on the surface.
struct PassTaps {
  std::vector<double> offsets_mm;
  std::vector<std::array<float, 3>> weights;  ///< sum to 1 in every channel
};

std::unique_ptr<Opponent> make_dermis(const Case& what, const Scene& scene, const Device& device);
std::unique_ptr<Opponent> make_texture(const Case& what, const Scene& scene, const Device& device);
std::unique_ptr<Opponent> make_naive(const Case& what, const Scene& scene, const Device& device);
std::unique_ptr<Opponent> make_rule_2012(const Case& what, const Scene& scene, const Device& device);
std::unique_ptr<Opponent> make_simd(const Case& what, const Scene& scene);
std::unique_ptr<Opponent> make_fft(const Scene& scene);
std::unique_ptr<Opponent> make_opencv_separable(const Scene& scene);
std::unique_ptr<Opponent> make_opencv_bilateral(const Scene& scene);

/// Whether the program was built with OpenCV. Without it the two functions above throw Error(usage).
bool has_opencv();

/// Any of them. `device` has as many threads as the case asks for.
std::unique_ptr<Opponent> make_opponent(const Case& what, const Scene& scene, const Device& device);

/// Image reads per pixel of a run; 0 where that is not the measure.
double loads_of(const Case& what);

/// Half the width of the dense kernel that OpenCV is given, px.
int dense_reach_px(const SceneSpec& scene);

}  // namespace dermis::bench
