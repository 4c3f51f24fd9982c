#include "commands/unseen_weight.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "arguments/device_arguments.hpp"
#include "arguments/quality_arguments.hpp"
#include "dermis/plan.hpp"
#include "files/loaded_frame.hpp"

namespace dermis::program {
namespace {

/// Adds a pixel whose camera sees such shares of the profile's weight.
void add_pixel(UnseenWeight& unseen, const float* seen) {
  constexpr double much = 0.1;
  double share = 0;
  for (std::size_t c = 0; c < 3; ++c) share += std::max(0.0, 1 - static_cast<double>(seen[c])) / 3;
  unseen.mean_share += share;
  if (share >= much) unseen.pixels_missing += 1;
}

}  // namespace

std::vector<UnseenWeight> find_unseen_weights(const exr::Picture& picture, const exr::Roles& roles,
                                              const exr::FoundCamera& camera, const std::vector<NamedProfile>& profiles,
                                              double mm_per_unit, const std::filesystem::path& folder,
                                              const std::string& cache_folder) {
  const std::vector<MatteId> mattes = mattes_of(profiles);
  require_roles(picture, roles, profiles, !mattes.empty());
  LoadedFrame loaded = load_images(picture, roles, profiles, mattes, folder);
  loaded.depth = load_depth_image(picture, roles, camera);
  std::fill(loaded.light.begin(), loaded.light.end(), 1.0F);
  std::vector<float> seen(loaded.light.size());
  Frame frame = loaded.frame();
  frame.camera = camera.camera;
  frame.mm_per_unit = mm_per_unit;
  frame.scattered = {.host = seen.data()};
  const Options options{.quality = default_quality, .sums_weights = true, .cache_folder = cache_folder};
  Plan(open_device({}), program::materials_of(profiles), FrameDescription::of(frame), options).run(frame);

  const std::vector<std::uint8_t> scatters = scattering_pixels(loaded, profiles);
  std::vector<UnseenWeight> all;
  for (const NamedProfile& named : profiles) {
    UnseenWeight unseen;
    std::int64_t pixels = 0;
    for (std::size_t i = 0; i < scatters.size(); ++i) {
      const bool is_its = !named.id || loaded.material[i] == static_cast<float>(*named.id);
      if (scatters[i] == 0 || !is_its || !std::isfinite(seen[3 * i] + seen[3 * i + 1] + seen[3 * i + 2])) continue;
      add_pixel(unseen, &seen[3 * i]);
      ++pixels;
    }
    if (pixels > 0) {
      unseen.mean_share /= static_cast<double>(pixels);
      unseen.pixels_missing /= static_cast<double>(pixels);
    }
    all.push_back(unseen);
  }
  return all;
}

}  // namespace dermis::program
