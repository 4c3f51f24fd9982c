#include "report/stats_report.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>

#include "dermis/version.hpp"
#include "exr/message_text.hpp"
#include "report/json_text.hpp"
#include "report/role_text.hpp"
#include "report/tile_map.hpp"

namespace dermis::program {
namespace {

using nlohmann::json;

json json_of(const DeviceInfo& device) {
  return {{"name", device.name},
          {"platform", device.platform},
          {"driver", device.driver},
          {"type", device.type},
          {"compute_units", device.compute_units},
          {"vector_width", device.vector_width},
          {"memory_bytes", device.memory_bytes},
          {"max_buffer_bytes", device.max_buffer_bytes}};
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json disc_of(const Options& options) {
  if (options.method != Method::disc) return nullptr;
  return {{"samples", options.disc.samples > 0 ? json(options.disc.samples) : json("auto")},
          {"plane", options.disc.tangent_plane ? "tangent" : "screen"},
          {"prefiltered", options.disc.prefiltered},
          {"accumulate", options.disc.accumulate}};
}

json design_of(const MaterialReport& material) {
  if (!material.taps) return nullptr;
  const auto& [design, count, predicted_rel_l2] = *material.taps;
  const bool is_seen = material.pixel_mm.has_value();
  return {{"model", name_of(design.model)},
          {"rank", design.rank},
          {"taps", is_seen ? json(count) : json(nullptr)},
          {"most_taps", design.count},
          {"placement", name_of(design.placement)},
          {"guide", design.model == Model::guided ? json(design.guide) : json(nullptr)},
          {"non_negative", design.non_negative},
          {"predicted_rel_l2", is_seen ? json(predicted_rel_l2) : json(nullptr)}};
}

json json_of(const MaterialReport& material) {
  return {{"id", material.id ? json(*material.id) : json(nullptr)},
          {"name", material.name ? json(*material.name) : json(nullptr)},
          {"profile", material.profile},
          {"radius_mm", material.radius_mm},
          {"pixels", material.pixels},
          {"pixel_mm", or_null(material.pixel_mm)},
          {"design", design_of(material)}};
}

json hidden_light_of(const StatsReport& report) {
  if (report.views.empty()) return nullptr;
  json object = {{"pixels", report.stats.pixels_reached}, {"views", json::array()}};
  for (std::size_t i = 0; i < report.views.size(); ++i) {
    const auto& [seen, hidden, contradicting] = report.stats.views[i];
    object["views"].push_back(
        {{"file", report.views[i]}, {"seen", seen}, {"hidden", hidden}, {"contradicting", contradicting}});
  }
  return object;
}

json times_of(const StatsReport& report) {
  return {{"read", report.times.read_ms},       {"plan", report.times.plan_ms},
          {"prepare", report.stats.prepare_ms}, {"classify", report.stats.classify_ms},
          {"scatter", report.stats.scatter_ms}, {"views", report.stats.views_ms},
          {"finish", report.stats.finish_ms},   {"run", report.times.run_ms},
          {"write", report.times.write_ms},     {"total", report.times.total_ms}};
}

std::string text_of(const MaterialReport& material) {
  std::string text = fmt::format("material {:<2} {}, {} pixels, radius {:.3g} mm\n",
                                 material.name ? exr::escaped(*material.name)
                                 : material.id ? std::to_string(*material.id)
                                               : "",
                                 exr::escaped(material.profile), material.pixels, material.radius_mm);
  if (!material.taps) return text;
  const auto& [design, count, predicted_rel_l2] = *material.taps;
  text += fmt::format("            {} rank {}, {}{} taps, placement {}", name_of(design.model), design.rank,
                      design.tolerance > 0 ? "up to " : "", design.count, name_of(design.placement));
  if (design.model == Model::guided) text += fmt::format(", guide {}", design.guide);
  if (design.non_negative) text += ", not negative";
  text += '\n';
  if (material.pixel_mm)
    text += fmt::format("            {} taps, predicted error {:.3g} % for pixels of {:.3g} mm\n", count,
                        100 * predicted_rel_l2, *material.pixel_mm);
  return text;
}

/// The tolerance that was asked for, or that of the quality; 0 if neither was, or the reference.
double tolerance_of(const Options& asked) {
  return asked.quality ? dermis::tolerance_of(*asked.quality) : asked.tolerance;
}

double percent(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::string counted(std::string_view name, std::int64_t part, std::int64_t whole) {
  return fmt::format("  {:<18}{:>12}  {:5.1f} %\n", name, part, percent(part, whole));
}

std::string text_of_steps(const StatsReport& report) {
  const Stats& stats = report.stats;
  const StepTimes& times = report.times;
  std::string text = "time, ms\n";
  const auto line = [&](std::string_view name, double ms) { text += fmt::format("  {:<18}{:>12.1f}\n", name, ms); };
  line("read", times.read_ms);
  line("plan", times.plan_ms);
  line("run", times.run_ms);
  line("  prepare", stats.prepare_ms);
  line("  classify", stats.classify_ms);
  line("  scatter", stats.scatter_ms);
  if (!report.views.empty()) line("  views", stats.views_ms);
  line("  finish", stats.finish_ms);
  if (times.total_ms == 0) return text;  // as long as the result is not written
  line("write", times.write_ms);
  line("total", times.total_ms);
  return text;
}

}  // namespace

json json_of(const StatsReport& report) {
  const Stats& stats = report.stats;
  const double tolerance = tolerance_of(report.asked);
  json object = {{"version", DERMIS_VERSION},
                 {"device", json_of(report.device)},
                 {"method", name_of(report.options.method)},
                 {"quality", report.asked.quality ? json(name_of(*report.asked.quality)) : json(nullptr)},
                 {"tolerance", tolerance > 0 ? json(tolerance) : json(nullptr)},
                 {"sheared", report.options.sheared},
                 {"jitter", report.options.jitter},
                 {"seed", report.options.seed},
                 {"disc", disc_of(report.options)},
                 {"times_ms", times_of(report)},
                 {"camera", program::json_of(report.camera)},
                 {"roles", program::json_of(report.roles)},
                 {"materials", json::array()},
                 {"input", report.input},
                 {"notes", report.notes},
                 {"warnings", report.warnings}};
  object["bands"] = stats.bands;
  object["blocks"] = {{"total", stats.blocks.kinds.size()}};
  for (const auto& [kind, name] : word_table<TileKind>) object["blocks"][std::string(name)] = stats.blocks.count(kind);
  object["pixels"] = {{"total", stats.pixels},
                      {"scattered", stats.pixels_scattered},
                      {"without_material", stats.pixels_without_material},
                      {"narrow", stats.pixels_narrow},
                      {"flat", stats.pixels_flat},
                      {"narrow_channels", stats.channels_narrow},
                      {"bad", stats.pixels_bad},
                      {"unlit", stats.pixels_unlit}};
  object["hidden_light"] = hidden_light_of(report);
  for (const MaterialReport& material : report.materials) object["materials"].push_back(json_of(material));
  return object;
}

std::string text_of(const StatsReport& report) {
  const Stats& stats = report.stats;
  const Options& options = report.options;
  std::string text = fmt::format("device      {} ({}, {} compute units)\n", report.device.name, report.device.platform,
                                 report.device.compute_units);
  text += fmt::format("camera      {}\n", text_of(report.camera));
  text += fmt::format("method      {}", name_of(options.method));
  if (options.method == Method::separable) {
    text += fmt::format(", shear {}, jitter {}, seed {}", options.sheared ? "on" : "off", options.jitter, options.seed);
  }
  if (options.method == Method::disc) {
    const DiscOptions& disc = options.disc;
    text += fmt::format(", {} samples, {} plane, {}accumulate {}, seed {}",
                        disc.samples > 0 ? std::to_string(disc.samples) : "21 or 55",
                        disc.tangent_plane ? "tangent" : "screen", disc.prefiltered ? "prefiltered, " : "",
                        disc.accumulate, options.seed);
  }
  if (report.asked.quality) text += fmt::format(", quality {}", name_of(*report.asked.quality));
  if (const double tolerance = tolerance_of(report.asked); tolerance > 0)
    text += fmt::format(", tolerance {}", tolerance);
  text += '\n';
  for (const MaterialReport& material : report.materials) text += text_of(material);
  const auto blocks = static_cast<std::int64_t>(stats.blocks.kinds.size());
  if (stats.bands > 1) text += fmt::format("bands       {}\n", stats.bands);
  text += fmt::format("blocks      {}\n", blocks);
  for (const auto& [kind, name] : word_table<TileKind>)
    text += counted(in_words(name), stats.blocks.count(kind), blocks);
  text += fmt::format("pixels      {}\n", stats.pixels);
  text += counted("scattered", stats.pixels_scattered, stats.pixels);
  text += counted("without material", stats.pixels_without_material, stats.pixels);
  text += counted("narrow", stats.pixels_narrow, stats.pixels);
  text += counted("flat", stats.pixels_flat, stats.pixels);
  text += counted("bad", stats.pixels_bad, stats.pixels);
  if (options.method == Method::disc) text += counted("unlit", stats.pixels_unlit, stats.pixels);
  if (!report.views.empty()) text += counted("reached by views", stats.pixels_reached, stats.pixels);
  text += fmt::format("channels    {}\n", 3 * stats.pixels_scattered);
  text += counted("narrow", stats.channels_narrow, 3 * stats.pixels_scattered);
  for (std::size_t i = 0; i < report.views.size(); ++i) {
    const std::int64_t all = stats.views[i].seen + stats.views[i].hidden;
    text += fmt::format("view        {}, {} pixels of surface\n", exr::escaped(report.views[i]), all);
    text += counted("hidden", stats.views[i].hidden, all);
    text += counted("seen", stats.views[i].seen, all);
  }
  return text + text_of_steps(report);
}

std::string json_text_of(const std::vector<StatsReport>& views) {
  if (views.size() == 1) return json_text(json_of(views.front()));
  json object = {{"views", json::array()}};
  for (const StatsReport& view : views) object["views"].push_back(json_of(view));
  return json_text(object);
}

}  // namespace dermis::program
