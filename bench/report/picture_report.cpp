#include "report/picture_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "dermis/error.hpp"
#include "dermis/version.hpp"
#include "report/chart.hpp"
#include "report/gnuplot.hpp"
#include "support/machine.hpp"

namespace dermis::bench {

namespace {

std::string errors_of(const PictureRow& row) {
  std::string text;
  for (const double error : row.rel_l2) text += fmt::format(" {:.2f} % |", 100 * error);
  text += fmt::format(" {:.2f} % |", 100 * row.edge_rel_l2);
  return text;
}

std::string_view name_of(Method method) {
  return method == Method::exact ? "exact" : method == Method::disc ? "disc" : "separable";
}

nlohmann::ordered_json json_row(const PictureRow& row, const Subject& subject) {
  nlohmann::ordered_json errors;
  for (std::size_t i = 0; i < row.rel_l2.size(); ++i) errors[subject.material_names[i]] = row.rel_l2[i];
  return {{"name", row.what.name},
          {"method", name_of(row.what.options.method)},
          {"samples", row.what.options.disc.samples},
          {"rank", row.what.options.taps.rank},
          {"taps", row.what.options.taps.count},
          {"jitter", row.what.options.jitter},
          {"size", {subject.width, subject.height}},
          {"ms", row.ms},
          {"ms_p10", row.ms_p10},
          {"ms_p90", row.ms_p90},
          {"scatter_ms", row.scatter_ms},
          {"copy_ratio", row.copy_ratio},
          {"loads", row.loads},
          {"plan_ms", row.plan_ms},
          {"scratch_mib", row.scratch_mib},
          {"rel_l2", errors},
          {"edge_rel_l2", row.edge_rel_l2},
          {"max_err", row.max_error}};
}

/// What a plot joins by lines, in the order of the rows.
std::vector<std::string> series_of(const std::vector<PictureRow>& rows) {
  std::vector<std::string> series;
  for (const PictureRow& row : rows) {
    const bool is_new = std::find(series.begin(), series.end(), row.what.series) == series.end();
    if (is_new && !row.what.series.empty()) series.push_back(row.what.series);
  }
  return series;
}

}  // namespace

std::string table_of(const PictureMeasurement& measurement, const Subject& subject, const DeviceInfo& device) {
  std::string text =
      fmt::format("{}, {}x{}; {} ({}), {} threads, {} {}; a copy of four planes in and three out takes {:.2f} ms\n\n",
                  subject.name, subject.width, subject.height, processor_name(), device.name, device.compute_units,
                  device.platform, device.driver, measurement.copy_ms);
  text += "| method | loads per pixel | time, ms (p10..p90) | x copy | memory, MiB |";
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) {
    text += fmt::format(" {} ({} px) |", subject.material_names[i], measurement.pixels[i]);
  }
  text += fmt::format(" within 3 px of edges ({} px) |", measurement.edge_pixels);
  text += "\n|---|---|---|---|---|---|";
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) text += "---|";
  const PictureRow& rule = measurement.rule_2012;
  text += fmt::format("\n| {} | {} | | | |{}", rule.what.name, rule.loads, errors_of(rule));
  for (const PictureRow& row : measurement.rows) {
    text += fmt::format("\n| {} | {} | {:.1f} ({:.1f}..{:.1f}) | {:.1f} | {:.0f} |{}", row.what.name, row.loads, row.ms,
                        row.ms_p10, row.ms_p90, row.copy_ratio, row.scratch_mib, errors_of(row));
  }
  const PictureRow& exact = measurement.exact;
  text += fmt::format("\n| exact | all in reach | {:.0f} | {:.0f} | {:.0f} |{}\n", exact.ms, exact.copy_ratio,
                      exact.scratch_mib, errors_of(exact));
  return text;
}

std::string json_of(const PictureMeasurement& measurement, const Subject& subject, const DeviceInfo& device) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const PictureRow& row : measurement.rows) rows.push_back(json_row(row, subject));
  rows.push_back(json_row(measurement.exact, subject));
  const nlohmann::ordered_json object = {{"version", DERMIS_VERSION},       {"machine", processor_name()},
                                         {"device", device.name},           {"driver", device.driver},
                                         {"threads", device.compute_units}, {"picture", subject.name},
                                         {"copy_ms", measurement.copy_ms},  {"rows", rows}};
  return object.dump(2) + "\n";
}

void plot(const std::filesystem::path& path, const PictureMeasurement& measurement, const Subject& subject,
          const DeviceInfo& device) {
  constexpr const char* colours[] = {"#d1495b", "#2f6db5", "#2a8f6f", "#e08e1b", "#7a4fa3"};
  const std::vector<std::string> names = series_of(measurement.rows);
  Chart chart = {.title = fmt::format("{}, {}x{}, {} threads of {}", subject.name, subject.width, subject.height,
                                      device.compute_units, device.name),
                 .x_title = "time, ms",
                 .y_title = "relative L2 error against exact",
                 .settings =
                     "set format y '%g'\nset ytics (0.003,0.005,0.007,0.01,0.015,0.02,0.03,0.05,0.1)\n"
                     "set xtics (2,3,5,7,10,15,20,30,40,50,70,100,150,200,300)",
                 .series = {}};
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      Series series = {.title = subject.material_names[i] + ", " + names[k],
                       .colour = colours[i % std::size(colours)],
                       .point_type = 5 + 2 * static_cast<int>(i % 3),
                       .dash_type = 1 + static_cast<int>(k),
                       .points = {}};
      for (const PictureRow& row : measurement.rows) {
        if (row.what.series != names[k]) continue;
        const Options& options = row.what.options;
        const int count = options.method == Method::disc ? options.disc.samples : options.taps.count;
        series.points.push_back({row.ms, row.rel_l2[i], std::to_string(count)});
      }
      chart.series.push_back(std::move(series));
    }
  }
  double shortest = HUGE_VAL, longest = 0, least = HUGE_VAL, most = 0;
  for (const Series& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      shortest = std::min(shortest, point.x);
      longest = std::max(longest, point.x);
      least = std::min(least, point.y);
      most = std::max(most, point.y);
    }
  }
  if (longest == 0) return;  // --filter left no case of a series
  chart.settings +=
      fmt::format("\nset xrange [{}:{}]\nset yrange [{}:{}]", shortest * 0.9, longest * 1.1, least * 0.9, most * 1.2);
  draw_svg("--plot", path, 1100, 600, script_of(chart));
}

}  // namespace dermis::bench
