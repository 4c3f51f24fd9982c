#include <cmath>
#include <future>
#include <string>
#include <utility>

#include "dermis/error.hpp"
#include "dermis/plan.hpp"
#include "opencl/recent.hpp"
#include "taps/check_design.hpp"
#include "taps/kept/kept_taps.hpp"

namespace dermis {

namespace {

void check_quality(const Options& options) {
  const std::string method = "it with method " + std::string(name_of(options.method));
  if (!(options.tolerance >= 0 && options.tolerance < 1)) {
    throw Error(ErrorCode::usage, "tolerance", std::to_string(options.tolerance), "at least 0 and below 1");
  }
  if (options.quality && options.tolerance > 0) {
    throw Error(ErrorCode::usage, "tolerance", "it with quality " + std::string(name_of(*options.quality)),
                "one of the two");
  }
  if (options.method == Method::separable) return;
  if (options.tolerance > 0) throw Error(ErrorCode::usage, "tolerance", method, "method separable");
  const bool is_exact = options.method == Method::exact && options.quality == Quality::reference;
  if (options.quality && !is_exact) throw Error(ErrorCode::usage, "quality", method, "method separable");
}

/// The widest kernel to place taps for, px, of few sizes: twice the radius of 99.9 %, for those of ranks 2 and 3 hold
/// more. A kernel that is wider all the same has the taps of one half as wide.
int widest_kernel_px(const Profile& profile, double finest_pixel_mm) {
  const double radius_px = 2 * profile.half_width(profile.widest_channel(), 0.999) / finest_pixel_mm;
  for (const int size_px : {64, 96, 128, 192, 256, 384}) {
    if (radius_px <= size_px) return size_px;
  }
  return TapsDesign{}.widest_px;
}

/// A material that is to have a design of its own, as choose_design sees it.
struct ChoiceKey {
  Profile profile;
  TapsDesign wanted;
  double pixel_mm;
  bool operator==(const ChoiceKey&) const = default;
};

/// choose_design for the plans of one camera after the other, which ask for the same.
DesignChoice design_for(const ChoiceKey& key, const std::string& cache_folder) {
  static Recent<ChoiceKey, DesignChoice> choices(256, [](const DesignChoice&) { return 1; });
  return choices.get(key, [&] { return kept_choice(cache_folder, key.profile, key.wanted, key.pixel_mm); });
}

/// The designs of the materials that have a tolerance and a size of pixels, by that. Returns those that miss it.
std::vector<std::size_t> choose_designs(std::vector<Material>& materials, const std::string& cache_folder) {
  std::vector<std::future<DesignChoice>> choices(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& material = materials[i];
    if (material.taps->tolerance > 0 && material.pixel_mm > 0)
      choices[i] = std::async([&] {
        return design_for({material.profile, *material.taps, material.pixel_mm}, cache_folder);
      });
  }
  std::vector<std::size_t> missed;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!choices[i].valid()) continue;
    const DesignChoice choice = choices[i].get();
    materials[i].taps = choice.design;
    if (choice.predicted_rel_l2 > choice.design.tolerance) missed.push_back(i);
  }
  return missed;
}

}  // namespace

ChosenTaps choose_taps(std::vector<Material> materials, Options options) {
  constexpr double plain_passes_will_do = 0.02;
  check_quality(options);
  const bool is_else_exact = options.tolerance > 0;
  const double tolerance = options.quality ? tolerance_of(*options.quality) : options.tolerance;
  if (options.quality == Quality::reference) options.method = Method::exact;
  if (tolerance > 0) options.taps = design_within(tolerance, options.taps);
  if (tolerance >= plain_passes_will_do) options.sheared = false;
  options.quality.reset();
  options.tolerance = 0;

  for (Material& material : materials) {
    for (const double pixel_mm : {material.pixel_mm, material.finest_pixel_mm})
      if (pixel_mm != 0) check_pixel_mm(pixel_mm);
    if (!material.taps) material.taps = options.taps;
  }
  std::vector<std::size_t> missed;
  if (options.method == Method::separable) missed = choose_designs(materials, options.cache_folder);
  if (is_else_exact && !missed.empty()) options.method = Method::exact;
  for (Material& material : materials) {
    if (material.finest_pixel_mm > 0)
      material.taps->widest_px = widest_kernel_px(material.profile, material.finest_pixel_mm);
    material.pixel_mm = material.finest_pixel_mm = 0;
  }
  return {std::move(materials), std::move(options), std::move(missed)};
}

}  // namespace dermis
