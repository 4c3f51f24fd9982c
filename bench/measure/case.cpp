#include "measure/case.hpp"

#include <fmt/format.h>

namespace dermis::bench {

namespace {

std::string_view name_of(Model model) {
  switch (model) {
    case Model::pre_integrated:
      return "pre-integrated";
    case Model::artist:
      return "artist";
    case Model::guided:
      return "guided";
    case Model::svd:
      return "svd";
    case Model::gaussians:
      return "gaussians";
    case Model::optimised:
      return "optimised";
  }
  return "";
}

bool has_taps(Family family) {
  return family == Family::dermis || family == Family::naive || family == Family::rule_2012 || family == Family::simd ||
         family == Family::simd_depth;
}

}  // namespace

std::string_view name_of(Family family) {
  switch (family) {
    case Family::dermis:
      return "dermis";
    case Family::dermis_exact:
      return "dermis-exact";
    case Family::dermis_disc:
      return "dermis-disc";
    case Family::texture_gaussians:
      return "texture-gaussians";
    case Family::texture_recursive:
      return "texture-recursive";
    case Family::naive:
      return "naive";
    case Family::rule_2012:
      return "rule-2012";
    case Family::simd:
      return "simd";
    case Family::simd_depth:
      return "simd-depth";
    case Family::opencv_separable:
      return "opencv-separable";
    case Family::opencv_bilateral:
      return "opencv-bilateral";
    case Family::fft:
      return "fft";
    case Family::start_up:
      return "start-up";
  }
  return "";
}

std::string_view title_of(Group group) {
  switch (group) {
    case Group::methods:
      return "methods";
    case Group::coverage:
      return "coverage";
    case Group::width:
      return "kernel width";
    case Group::pixels:
      return "pixels";
    case Group::threads:
      return "threads and memory";
    case Group::flat:
      return "flat, against exact convolution";
    case Group::texture:
      return "texture space, against exact convolution";
    case Group::start_up:
      return "start-up";
  }
  return "";
}

std::string Case::model() const {
  switch (family) {
    case Family::dermis:
      return std::string(name_of(design.model));
    case Family::naive:
      return "importance";
    case Family::rule_2012:
      return "radial-slice";
    case Family::simd:
    case Family::simd_depth:
      return "optimised";
    default:
      return "";
  }
}

std::string Case::method() const {
  std::string text(name_of(family));
  if (family == Family::start_up) return text + (cache_is_filled ? "/cached" : "/cold");
  if (family == Family::dermis_disc)
    return text + fmt::format("/n{}{}", disc.samples, disc.prefiltered ? "/prefiltered" : "");
  if (tolerance > 0) return fmt::format("{}/within-{:g}%", text, 100 * tolerance);
  if (has_taps(family)) text += fmt::format("/{}/r{}/t{}", model(), design.rank, design.count);
  return text;
}

std::string Case::name() const {
  std::string text = method() + "/" + scene.name();
  if (!sheared) text += "/plain";
  if (threads > 0) text += fmt::format("/threads{}", threads);
  if (memory == Memory::interleaved_f16) text += "/rgba-half";
  return text;
}

}  // namespace dermis::bench
