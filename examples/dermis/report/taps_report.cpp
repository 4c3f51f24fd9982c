#include "report/taps_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "exr/message_text.hpp"
#include "report/json_text.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

std::string header_of(const TapsReport& report) {
  const TapSet& set = report.set;
  const auto taps = static_cast<int>(set.offsets_px.size());
  std::string text;
  const auto add = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<17}{}\n", name, value);
  };
  add("profile", exr::escaped(report.profile));
  if (report.width_follows_albedo) add("", "the albedo of each pixel scales it; this is its width at a factor of 1");
  add("model", std::string(name_of(report.design.model)));
  add("rank", std::to_string(set.terms.size()));
  add("taps",
      fmt::format("{} per pass{}", taps, taps < report.design.count ? ", one on every pixel of the kernel" : ""));
  add("placement", taps < report.design.count ? "every pixel" : std::string(name_of(report.design.placement)));
  add("fetch", std::string(name_of(set.fetch)));
  add("pixel", fmt::format("{} mm on the surface", set.pixel_mm));
  add("loads per pixel", std::to_string(loads_per_pixel(set)));
  add("predicted error", fmt::format("{:.3g} % relative L2 on natural images", 100 * set.predicted_rel_l2));
  return text;
}

/// The half of a term with offsets >= 0.
std::string half_of(const TapSet& set, std::size_t t) {
  const TapTerm& term = set.terms[t];
  const int decimals = set.fetch == Fetch::linear ? 4 : 0;
  std::string text = fmt::format("\nterm {} of {}, scale {:.9g} {:.9g} {:.9g}\n", t + 1, set.terms.size(),
                                 term.scale[0], term.scale[1], term.scale[2]);
  text += fmt::format("{:>12}{:>14}{:>14}{:>14}\n", "offset, px", "R", "G", "B");
  for (std::size_t i = set.offsets_px.size() / 2; i < set.offsets_px.size(); ++i) {
    const auto& weight = term.weights[i];
    text += fmt::format("{:>12.{}f}{:>14.8f}{:>14.8f}{:>14.8f}\n", set.offsets_px[i], decimals, weight[0], weight[1],
                        weight[2]);
  }
  return text;
}

}  // namespace

int loads_per_pixel(const TapSet& set) { return static_cast<int>((1 + set.terms.size()) * set.offsets_px.size()); }

std::string offset_text(double offset_px) {
  return offset_px == std::round(offset_px) ? fmt::format("{:.0f}", offset_px) : fmt::format("{}", offset_px);
}

std::string title_of(const TapsReport& report) {
  const TapSet& set = report.set;
  return fmt::format("{}: model {}, rank {}, {} taps, {} fetch, pixel {} mm, predicted error {:.3g} %", report.profile,
                     name_of(report.design.model), set.terms.size(), set.offsets_px.size(), name_of(set.fetch),
                     set.pixel_mm, 100 * set.predicted_rel_l2);
}

std::string table_of(const TapsReport& report) {
  std::string text = header_of(report);
  text += "\nThe kernel of a channel is the sum over terms of scale w(x) w(y). Offsets < 0 weigh the same as > 0.\n";
  for (std::size_t t = 0; t < report.set.terms.size(); ++t) text += half_of(report.set, t);
  return text;
}

std::string json_text_of(const TapsReport& report) {
  const TapSet& set = report.set;
  json terms = json::array();
  for (const TapTerm& term : set.terms) terms.push_back({{"scale", term.scale}, {"weights", term.weights}});
  return json_text(json{{"profile", report.profile},
                        {"model", name_of(report.design.model)},
                        {"rank", set.terms.size()},
                        {"taps", set.offsets_px.size()},
                        {"fetch", name_of(set.fetch)},
                        {"pixel_mm", set.pixel_mm},
                        {"predicted_rel_l2", set.predicted_rel_l2},
                        {"offsets_px", set.offsets_px},
                        {"terms", terms}});
}

std::string csv_of(const TapsReport& report) {
  std::string text = "offset_px,term,R,G,B,scale_R,scale_G,scale_B\n";
  for (std::size_t t = 0; t < report.set.terms.size(); ++t) {
    const TapTerm& term = report.set.terms[t];
    for (std::size_t i = 0; i < term.weights.size(); ++i)
      text += fmt::format("{},{},{},{}\n", offset_text(report.set.offsets_px[i]), t + 1,
                          fmt::join(term.weights[i], ","), fmt::join(term.scale, ","));
  }
  return text;
}

}  // namespace dermis::program
