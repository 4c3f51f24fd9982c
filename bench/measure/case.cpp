#include "measure/case.hpp"

#include <fmt/format.h>

namespace dermis::bench {

namespace {

bool has_taps(Family family) {
  return family == Family::dermis || family == Family::naive || family == Family::rule_2012 || family == Family::simd ||
         family == Family::simd_depth;
}

/// The name on a picture, without the number of taps or samples and what is unusual.
std::string method_on_picture(const Case& what) {
  switch (what.family) {
    case Family::dermis:
      if (what.design.model == Model::pre_integrated) return "importance-sampled";
      if (what.design.model == Model::gaussians) return fmt::format("{} Gaussians", what.design.rank);
      return fmt::format("{}, rank {}", what.model(), what.design.rank);
    case Family::dermis_disc:
      return what.disc.prefiltered ? "discs, prefiltered" : "discs";
    case Family::naive:
      return "naive OpenCL";
    case Family::rule_2012:
      return "rule of 2012, OpenCL";
    case Family::simd_depth:
      return "C++ vectors, depth";
    default:
      return "exact";
  }
}

std::string name_on_picture(const Case& what) {
  std::string text = method_on_picture(what);
  if (what.family == Family::dermis_disc) text += fmt::format(", {} samples", what.disc.samples);
  if (has_taps(what.family)) text += fmt::format(", {} taps", what.design.count);
  if (!what.sheared) text += ", plain passes";
  if (what.jitter > 0) text += fmt::format(", jitter {}", what.jitter);
  return text;
}

}  // namespace

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
  if (is_on_picture()) return name_on_picture(*this);
  std::string text = method() + "/" + scene.name();
  if (!sheared) text += "/plain";
  if (threads > 0) text += fmt::format("/threads{}", threads);
  if (memory == Memory::interleaved_f16) text += "/rgba-half";
  return text;
}

}  // namespace dermis::bench
