#include "files/other_passes.hpp"

#include <cstddef>

namespace dermis::program {

std::vector<float> load_other_passes(const exr::Picture& picture, const exr::Roles& roles) {
  std::vector<float> sum;
  for (const exr::OtherLight& other : roles.others) {
    const std::vector<float> light = exr::load(picture, other.light);
    const std::vector<float> colour = other.colour.empty() ? std::vector<float>() : exr::load(picture, {other.colour});
    sum.resize(light.size());
    for (std::size_t i = 0; i < light.size(); ++i) sum[i] += colour.empty() ? light[i] : light[i] * colour[i];
  }
  return sum;
}

}  // namespace dermis::program
