#include "screen/check_materials.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "dermis/error.hpp"
#include "opencl/params.hpp"

namespace dermis {

void check_materials(const std::vector<Material>& materials, bool frames_have_ids, bool frames_have_albedo) {
  const std::string count = std::to_string(materials.size());
  if (frames_have_ids && (materials.empty() || materials.size() > MAX_MATERIALS)) {
    throw Error(ErrorCode::usage, "materials", count, "1.." + std::to_string(MAX_MATERIALS));
  }
  if (!frames_have_ids && materials.size() != 1) {
    throw Error(ErrorCode::usage, "materials", count, "exactly 1, as the frames have no material ids");
  }
  std::set<int> ids;
  for (const Material& material : materials) {
    if (frames_have_ids && (material.id < 0 || material.id > 65535 || !ids.insert(material.id).second)) {
      throw Error(ErrorCode::usage, "material id", std::to_string(material.id), "different ids in 0..65535");
    }
    if (material.profile.width_follows_albedo() && !frames_have_albedo) {
      throw Error(ErrorCode::role_missing, "albedo", "no image",
                  "an albedo image, which a profile takes its width from");
    }
  }
}

bool any_follows_albedo(const std::vector<Material>& materials) {
  return std::any_of(materials.begin(), materials.end(),
                     [](const Material& material) { return material.profile.width_follows_albedo(); });
}

}  // namespace dermis
