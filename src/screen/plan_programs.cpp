#include "screen/plan_programs.hpp"

#include <sstream>

#include "dermis/tap_tables.hpp"
#include "screen/frame_images.hpp"

namespace dermis {

std::string common_options(const PlanSettings& settings) {
  std::ostringstream bounds;
  bounds << std::scientific << " -DFLATNESS=" << Taps::flatness << "f -DLEAST_CENTRE_WEIGHT=" << least_centre_weight
         << "f";
  return "-cl-std=CL1.2" + build_constant("MATERIALS", static_cast<int>(settings.materials.size())) +
         image_constants(settings.frames) + build_constant("PIXEL_WIDTH", settings.has_pixel_width() ? 1 : 0) +
         build_constant("JITTER", settings.options.jitter > 0 ? 1 : 0) +
         build_constant("SHEARED", settings.is_sheared() ? 1 : 0) +
         build_constant("SUMS_WEIGHTS", settings.options.sums_weights ? 1 : 0) + bounds.str();
}

PlanPrograms plan_programs(const PlanSettings& settings, const ScatterMethod& method, int terms) {
  const std::string options = common_options(settings);
  // Classification has a block in a work-group of pixels on GPUs, else rows of a block as vectors.
  const bool by_pixels = settings.item_is_pixel();
  const int classified_at_once = by_pixels ? 1 : BLOCK;
  const std::string by_block = options + build_constant("V", classified_at_once);
  PlanPrograms programs{
      {{by_pixels ? "classify/classify_pixels.cl" : "classify/classify.cl", "classify/choose_passes.cl"}, by_block},
      {},
      {},
      {{"classify/fingerprint.cl"}, by_block}};
  programs.method = method.kernels(terms);
  programs.method.files.emplace_back("frame/finish.cl");
  if (settings.has_curvature()) programs.method.files.emplace_back("frame/entering_light.cl");
  const std::string of_method = options + build_constant("V", method.vector_width()) +
                                build_constant("LIT", settings.options.lighting == Lighting::lit ? 1 : 0);
  programs.method.options = of_method + programs.method.options;
  programs.more = method.more_kernels(terms);
  for (ProgramSource& its : programs.more) its.options = of_method + its.options;
  // Every program costs PoCL 25 ms from its cache on disk, and 200 ms without, for headers and the library of built-in
  // functions: all kernels are in one if they have vectors of the same width.
  if (method.vector_width() == classified_at_once) {
    const std::vector<std::string>& files = programs.classification.files;
    programs.method.files.insert(programs.method.files.end(), files.begin(), files.end());
    programs.classification = programs.method;
  }
  return programs;
}

}  // namespace dermis
