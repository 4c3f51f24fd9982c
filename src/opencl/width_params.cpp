#include "opencl/width_params.hpp"

#include <algorithm>

namespace dermis {

params::WidthParams width_params(const Profile& profile) {
  params::WidthParams result{0, {1}, {1}};
  const auto& width = profile.albedo_width();
  if (!width) return result;
  result.follows_albedo = 1;
  const auto as_float = [](double value) { return static_cast<float>(value); };
  std::transform(width->numerator.begin(), width->numerator.end(), result.numerator, as_float);
  std::transform(width->denominator.begin(), width->denominator.end(), result.denominator, as_float);
  return result;
}

}  // namespace dermis
