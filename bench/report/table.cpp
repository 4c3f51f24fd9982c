#include <fmt/format.h>

#include <algorithm>

#include "opponents/opponents.hpp"
#include "report/report.hpp"
#include "support/machine.hpp"
#include "support/parallel.hpp"

namespace dermis::bench {

namespace {

std::string percent(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f} %", 100 * *value) : std::string("-");
}

std::string number_or_dash(double value, int digits) {
  return value > 0 ? fmt::format("{:.{}f}", value, digits) : std::string("-");
}

constexpr std::string_view line_format = "{:<{}}  {:>6} {:>9} {:>18} {:>8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8}\n";

std::string line_of(const Row& row, std::size_t name_width) {
  return fmt::format(line_format, row.what.name(), name_width, number_or_dash(row.loads, 0),
                     fmt::format("{:.2f}", row.ms), fmt::format("{:.2f}..{:.2f}", row.ms_p10, row.ms_p90),
                     number_or_dash(row.copy_ratio, 2), number_or_dash(row.gb_s, 1), number_or_dash(row.gflop_s, 1),
                     percent(row.rel_l2), percent(row.max_err), fmt::format("{:.0f}", row.plan_ms),
                     number_or_dash(row.peak_mb, 0));
}

std::string start_up_table(const std::vector<const Row*>& rows) {
  std::string text = fmt::format("\nstart-up: the first frame of a process, {}\n{:<12} {:>14} {:>14} {:>15} {:>10}\n",
                                 rows.front()->what.scene.name(), "caches", "first plan, ms", "first run, ms",
                                 "second plan, ms", "process MB");
  for (const Row* row : rows) {
    text +=
        fmt::format("{:<12} {:>14.0f} {:>14.0f} {:>15.0f} {:>10.0f}\n", row->what.cache_is_filled ? "filled" : "empty",
                    row->plan_ms, row->first_run_ms, row->second_plan_ms.value_or(0), row->peak_mb);
  }
  return text;
}

/// Markdown, for reports on a picture.
std::string picture_table(const std::vector<const Row*>& rows, const Measurement& measurement) {
  std::string text = "\n| method | loads per pixel | time, ms (p10..p90) | x copy | memory, MiB |";
  std::string rule = "\n|---|---|---|---|---|";
  for (const auto& [name, pixels] : measurement.parts) {
    text += fmt::format(" {} ({} px) |", name, pixels);
    rule += "---|";
  }
  text += rule + "\n";
  for (const Row* row : rows) {
    const std::string loads = row->loads > 0 ? fmt::format("{}", row->loads) : "all in reach";
    const std::string times = row->runs == 1 ? fmt::format("{:.0f} | {:.0f}", row->ms, row->copy_ratio)
                                             : fmt::format("{:.1f} ({:.1f}..{:.1f}) | {:.1f}", row->ms, row->ms_p10,
                                                           row->ms_p90, row->copy_ratio);
    const std::string memory = row->scratch_mib > 0 ? fmt::format("{:.0f}", row->scratch_mib) : "";
    text += fmt::format("| {} | {} | {} | {} |", row->what.name(), loads, times, memory);
    for (const double error : row->rel_l2_of_parts) text += fmt::format(" {:.2f} % |", 100 * error);
    text += "\n";
  }
  return text;
}

std::string group_table(Group group, const std::vector<const Row*>& rows) {
  std::size_t name_width = 0;
  for (const Row* row : rows) name_width = std::max(name_width, row->what.name().size());
  std::string text = "\n";
  text += fmt::format(line_format, name_of(group), name_width, "loads", "ms", "p10..p90", "x copy", "GB/s", "GFLOP/s",
                      "rel L2", "max", "plan ms", "peak MB");
  for (const Row* row : rows) text += line_of(*row, name_width);
  return text;
}

/// What opponents leave out, once for each of them.
std::string limits_of_all(const Measurement& measurement) {
  std::map<std::string_view, std::string> limits;
  for (const Row& row : measurement.rows) limits[name_of(row.what.family)] = limits_of(row.what);
  std::erase_if(limits, [](const auto& one) { return one.second.empty(); });
  std::string text;
  for (const auto& [family, its] : limits) text += fmt::format("- {} {}\n", family, its);
  return text.empty() ? text : "\n" + text;
}

std::string against_table(const Measurement& measurement) {
  std::size_t width = 0;
  for (const Row& row : measurement.rows) width = std::max(width, row.what.name().size());
  constexpr std::string_view format = "{:<{}}  {:>9} {:>9} {:>7} {:>14} {:>7}\n";
  std::string text = "\n" + fmt::format(format, "against " + measurement.against, width, "ms", "its ms", "ratio",
                                        "p10..p90", "rounds");
  for (const Row& row : measurement.rows) {
    const std::string ms = fmt::format("{:.2f}", row.ms);
    const OtherTimes other = row.other.value_or(OtherTimes{});
    text += row.other ? fmt::format(format, row.what.name(), width, ms, fmt::format("{:.2f}", other.ms),
                                    fmt::format("{:.3f}", other.ratio),
                                    fmt::format("{:.3f}..{:.3f}", other.ratio_p10, other.ratio_p90), row.runs)
                      : fmt::format(format, row.what.name(), width, ms, "-", "-", "-", row.runs);
  }
  return text +
         "\nms: wall clock, medians of rounds in each of which both builds run the case once, in either order. ratio: "
         "of the medians, below 1\nwhere this build is faster; p10..p90: of the ratios within rounds. -: the other "
         "build has no such case. Start-up has no rounds.\n";
}

std::string truths_of(const Measurement& measurement) {
  std::map<std::string, std::string> truths;
  for (const Row& row : measurement.rows) {
    if (row.rel_l2) truths[row.what.scene.name()] = row.truth;
  }
  std::string text;
  for (const auto& [scene, truth] : truths) text += fmt::format("  {}: {}\n", scene, truth);
  return text;
}

constexpr std::string_view legend =
    "\nms: wall clock, median of interleaved rounds. x copy: against reading four and writing three planes of that "
    "size "
    "on all cores in the same\nrounds. loads: pixels read per pixel and run. GB/s and GFLOP/s: 16 bytes and 12 "
    "operations per load. rel L2, max: of the first result from the\ntruth, over covered pixels, max in units of its "
    "mean. plan ms: until it can run, in this process. peak MB: memory beyond the scene until the\nfirst result. "
    "Opponents keep their images in the layout that suits them, on the device if they are of OpenCL; dermis takes the "
    "caller's.\n";

}  // namespace

std::string table_of(const Measurement& measurement) {
  const DeviceInfo& device = measurement.device;
  std::string text = fmt::format("{}, {} cores; {}, {} threads, {} {}\n", processor_name(), core_count(), device.name,
                                 device.compute_units, device.platform, device.driver);
  if (!measurement.picture.empty()) text = measurement.picture + "; " + text;
  if (measurement.load_before > 0.5) {
    text += fmt::format("others kept {:.1f} cores busy before it began: times are too long, and ratios too\n",
                        measurement.load_before);
  }
  for (const auto& [size, ms] : measurement.copy_ms) {
    text += fmt::format("copy of {}x{}: {:.3f} ms, {:.1f} GB/s\n", size.first, size.second, ms,
                        7.0 * sizeof(float) * size.first * size.second / (ms * 1e6));
  }
  if (!measurement.against.empty()) return text + against_table(measurement);
  for (const auto& [group, name] : word_table<Group>) {
    std::vector<const Row*> rows;
    for (const Row& row : measurement.rows) {
      if (row.what.group == group) rows.push_back(&row);
    }
    if (rows.empty()) continue;
    text += group == Group::start_up  ? start_up_table(rows)
            : group == Group::picture ? picture_table(rows, measurement)
                                      : group_table(group, rows);
  }
  text += limits_of_all(measurement);
  if (!measurement.picture.empty()) return text;
  const std::string truths = truths_of(measurement);
  if (!truths.empty()) text += "\nerrors are against\n" + truths;
  return text + std::string(legend);
}

}  // namespace dermis::bench
