// Makes the opponent that a case names.
#pragma once

#include <memory>
#include <string>

#include "dermis/device.hpp"
#include "measure/case.hpp"
#include "measure/scene.hpp"
#include "opponents/opponent.hpp"

namespace dermis::bench {

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

/// What an opponent leaves out that the surface integral has; empty if it is dermis, which METHODS.md describes.
std::string limits_of(const Case& what);

/// How much farther a profile reaches than "skin".
double width_over_skin(const Profile& profile);

/// The difference of depth, mm, from which the naive and the vectorised filter count a tap as on another surface: the
/// largest standard deviation of skin, near which both are least off on the spheres and on the sample picture.
double depth_radius_mm(const Profile& profile);

/// Image reads per pixel of a run; 0 where that is not the measure.
double loads_of(const Case& what);

/// Half the width of the dense kernel that OpenCV is given, px.
int dense_reach_px(const SceneSpec& scene);

}  // namespace dermis::bench
