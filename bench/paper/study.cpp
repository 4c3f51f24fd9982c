#include "paper/study.hpp"

#include <cmath>

namespace dermis::bench {

namespace {

/// The standard deviation of the widest of the six Gaussians.
const double skin_deviation_mm = std::sqrt(7.41);

Sample sample_of(const std::string& name, double width_in_px) {
  const Profile& profile = preset(name).profile;
  const double width_mm = name == "skin" ? skin_deviation_mm : axis_deviation_mm(profile, profile.widest_channel());
  return make_sample(name, profile, width_mm, width_in_px);
}

}  // namespace

Study make_study(const std::filesystem::path& folder, const std::function<void(const std::string&)>& report) {
  constexpr int natural_pictures = 4;
  constexpr std::uint32_t seed = 20150601;
  Study study{{}, {}, Pictures::natural(natural_pictures, seed), Pictures::dot(dot_radius_px), folder};
  for (const char* name : {"skin", "skin-measured", "dipole-skin1", "dipole-marble"}) {
    report(std::string("exact convolution with ") + name);
    Medium medium{sample_of(name, width_px), {}, {}};
    medium.rank_1 = pre_integrated(medium.sample.profile, medium.sample.pixel_mm);
    medium.svd = svd_of(medium.sample);
    study.media.push_back(std::move(medium));
  }
  for (const char* name : {"skin", "skin-measured"}) {
    report(std::string("exact convolution with ") + name + " at twice the width");
    study.wider.push_back(sample_of(name, 2 * width_px));
  }
  return study;
}

}  // namespace dermis::bench
