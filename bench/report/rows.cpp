#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "dermis/version.hpp"
#include "opponents/opponents.hpp"
#include "report/report.hpp"
#include "support/machine.hpp"
#include "support/parallel.hpp"

namespace dermis::bench {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json or_null(double value) { return value > 0 ? Json(value) : Json(nullptr); }

Json or_null(bool is_known, const Json& value) { return is_known ? value : Json(nullptr); }

Json json_of(const Row& row, const std::vector<PartSize>& parts) {
  const Case& what = row.what;
  const bool is_made = !what.is_on_picture();
  const bool has_taps = !what.model().empty();
  const std::string limits = limits_of(what);
  const OtherTimes other = row.other.value_or(OtherTimes{});
  Json object = {{"name", what.name()},
                 {"group", name_of(what.group)},
                 {"method", name_of(what.family)},
                 {"model", or_null(has_taps, what.model())},
                 {"rank", or_null(has_taps, what.design.rank)},
                 {"taps", or_null(has_taps, what.design.count)},
                 {"samples", or_null(what.family == Family::dermis_disc, what.disc.samples)},
                 {"jitter", what.jitter},
                 {"scene", name_of(what.scene.geometry)},
                 {"width_px", or_null(is_made, what.scene.kernel_px)},
                 {"size", {what.scene.width, what.scene.height}},
                 {"coverage", or_null(is_made, what.scene.coverage_percent)},
                 {"threads", what.threads == 0 ? Json("all") : Json(what.threads)},
                 {"memory", what.memory == Memory::interleaved_f16 ? "interleaved f16"
                            : is_made                              ? "planar f32"
                                                                   : "interleaved f32"},
                 {"runs", row.runs},
                 {"ms", or_null(row.ms)},
                 {"ms_p10", or_null(row.ms_p10)},
                 {"ms_p90", or_null(row.ms_p90)},
                 {"other_ms", or_null(other.ms)},
                 {"other_ratio", or_null(other.ratio)},
                 {"copy_ratio", or_null(row.copy_ratio)},
                 {"loads", or_null(row.loads)},
                 {"gb_s", or_null(row.gb_s)},
                 {"gflop_s", or_null(row.gflop_s)},
                 {"rel_l2", or_null(row.rel_l2)},
                 {"max_err", or_null(row.max_err)},
                 {"truth", or_null(!row.truth.empty(), row.truth)},
                 {"plan_ms", or_null(row.plan_ms)},
                 {"first_run_ms", or_null(row.first_run_ms)},
                 {"second_plan_ms", or_null(row.second_plan_ms)},
                 {"peak_mb", or_null(row.peak_mb)},
                 {"scratch_mib", or_null(row.scratch_mib)},
                 {"kernel_cache", or_null(what.family == Family::start_up, what.cache_is_filled ? "filled" : "empty")},
                 {"limits", or_null(!limits.empty(), limits)},
                 {"rel_l2_of_parts", nullptr}};
  for (std::size_t i = 0; i < row.rel_l2_of_parts.size(); ++i) {
    object["rel_l2_of_parts"][parts[i].name] = row.rel_l2_of_parts[i];
  }
  object["stages_ms"] = row.stages_ms ? Json(*row.stages_ms) : Json(nullptr);
  return object;
}

/// A JSON value as a field of a CSV file.
std::string field_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

}  // namespace

std::string json_of(const Measurement& measurement) {
  Json copy_ms = Json::object();
  for (const auto& [size, ms] : measurement.copy_ms) copy_ms[fmt::format("{}x{}", size.first, size.second)] = ms;
  Json rows = Json::array();
  for (const Row& row : measurement.rows) rows.push_back(json_of(row, measurement.parts));
  const DeviceInfo& device = measurement.device;
  const Json object = {
      {"version", DERMIS_VERSION},
      {"machine", {{"cpu", processor_name()}, {"cores", core_count()}, {"load_before", measurement.load_before}}},
      {"device", device.name},
      {"platform", device.platform},
      {"driver", device.driver},
      {"threads", device.compute_units},
      {"picture", or_null(!measurement.picture.empty(), measurement.picture)},
      {"against", or_null(!measurement.against.empty(), measurement.against)},
      {"copy_ms", copy_ms},
      {"rows", rows}};
  return object.dump(2) + "\n";
}

std::string csv_of(const Measurement& measurement) {
  std::string text;
  for (const Row& row : measurement.rows) {
    Json fields = json_of(row, measurement.parts);
    fields["size"] = fmt::format("{}x{}", row.what.scene.width, row.what.scene.height);
    for (const char* stage : {"prepare", "classify", "scatter", "finish"}) {
      fields[fmt::format("{}_ms", stage)] = row.stages_ms ? Json(row.stages_ms->at(stage)) : Json(nullptr);
    }
    fields.erase("stages_ms");
    const Json parts = fields["rel_l2_of_parts"];
    fields.erase("rel_l2_of_parts");
    for (const auto& [part, error] : parts.items()) fields["rel_l2 " + part] = error;
    std::string names;
    std::string values;
    for (const auto& [name, value] : fields.items()) {
      const char* comma = names.empty() ? "" : ",";
      names += comma + name;
      const std::string field = field_of(value);
      values += comma + (field.find(',') == std::string::npos ? field : "\"" + field + "\"");
    }
    if (text.empty()) text = names + "\n";
    text += values + "\n";
  }
  return text;
}

}  // namespace dermis::bench
