#include "opponents/opponents.hpp"

#include <cmath>

#include "dermis/error.hpp"

namespace dermis::bench {

int dense_reach_px(const SceneSpec& scene) {
  constexpr double reach = 3.3;  // standard deviations: 99.9 % of a Gaussian, as far as dermis looks in rank 1
  return static_cast<int>(std::lround(reach * scene.kernel_px));
}

double width_over_skin(const Profile& profile) {
  // 99.9 % of the marginal lie within it, which the program calls the radius of a kernel.
  const auto reach_mm = [](const Profile& one) { return one.half_width(one.widest_channel(), 0.999); };
  return reach_mm(profile) / reach_mm(skin());
}

double depth_radius_mm(const Profile& profile) { return skin_width_mm * width_over_skin(profile); }

std::string limits_of(const Case& what) {
  switch (what.family) {
    case Family::naive:
      return "takes every surface to face the camera";
    case Family::rule_2012:
      return "takes every surface to face the camera, and light from other materials and from what does not scatter, "
             "the less the farther that is in depth; leaves all light where it is if R has a pole at 0, as Burley's";
    case Family::simd_depth:
      return "takes every surface to face the camera, and each material to lie at the median depth of its pixels";
    case Family::simd:
    case Family::opencv_separable:
    case Family::opencv_bilateral:
    case Family::fft:
      return "knows no depth and no materials";
    default:
      return "";
  }
}

double loads_of(const Case& what) {
  switch (what.family) {
    case Family::dermis:
    case Family::start_up:
      return (1.0 + what.design.rank) * what.design.count;
    case Family::naive:
    case Family::simd:
    case Family::simd_depth:
      return 2.0 * what.design.count;
    case Family::rule_2012:
      return 2.0 * (2 * what.design.count - 1);  // two pixels for every tap but the centre
    case Family::opencv_separable:
      return 2.0 * (2 * dense_reach_px(what.scene) + 1);
    case Family::opencv_bilateral:
      return 15 * 15;
    case Family::dermis_disc:
      return 4.0 * what.disc.samples;
    case Family::dermis_exact:
    case Family::texture_gaussians:
    case Family::texture_recursive:
    case Family::fft:
      return 0;
  }
  return 0;
}

std::unique_ptr<Opponent> make_opponent(const Case& what, const Scene& scene, const Device& device) {
  switch (what.family) {
    case Family::dermis:
    case Family::dermis_exact:
    case Family::dermis_disc:
    case Family::start_up:
      return make_dermis(what, scene, device);
    case Family::texture_gaussians:
    case Family::texture_recursive:
      return make_texture(what, scene, device);
    case Family::naive:
      return make_naive(what, scene, device);
    case Family::rule_2012:
      return make_rule_2012(what, scene, device);
    case Family::simd:
    case Family::simd_depth:
      return make_simd(what, scene);
    case Family::opencv_separable:
      return make_opencv_separable(scene);
    case Family::opencv_bilateral:
      return make_opencv_bilateral(scene);
    case Family::fft:
      return make_fft(scene);
  }
  throw Error(ErrorCode::usage, "case", what.name(), "something that filters");
}

}  // namespace dermis::bench
