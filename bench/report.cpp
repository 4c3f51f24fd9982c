#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "dermis/error.hpp"
#include "dermis/version.hpp"

namespace dermis::bench {

namespace {

/// The processor, as Linux names it.
std::string machine() {
  std::ifstream lines("/proc/cpuinfo");
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string errors_of(const Row& row) {
  std::string text;
  for (const double error : row.rel_l2) text += fmt::format(" {:.2f} % |", 100 * error);
  return text;
}

nlohmann::ordered_json json_row(const Row& row, const Subject& subject) {
  nlohmann::ordered_json errors;
  for (std::size_t i = 0; i < row.rel_l2.size(); ++i) errors[subject.material_names[i]] = row.rel_l2[i];
  return {{"name", row.what.name},
          {"method", row.what.options.method == Method::exact ? "exact" : "separable"},
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
          {"rel_l2", errors},
          {"max_err", row.max_error}};
}

/// What a plot joins by lines, in the order of the rows.
std::vector<std::string> series_of(const std::vector<Row>& rows) {
  std::vector<std::string> series;
  for (const Row& row : rows) {
    const bool is_new = std::find(series.begin(), series.end(), row.what.series) == series.end();
    if (is_new && !row.what.series.empty()) series.push_back(row.what.series);
  }
  return series;
}

}  // namespace

std::string table_of(const Measurement& measurement, const Subject& subject, const DeviceInfo& device) {
  std::string text = fmt::format("{}, {}x{}; {} ({}), {} threads, {} {}; a copy of the same bytes takes {:.2f} ms\n\n",
                                 subject.name, subject.width, subject.height, machine(), device.name,
                                 device.compute_units, device.platform, device.driver, measurement.copy_ms);
  text += "| method | loads per pixel | time, ms (p10..p90) | x copy |";
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) {
    text += fmt::format(" {} ({} px) |", subject.material_names[i], measurement.pixels[i]);
  }
  text += "\n|---|---|---|---|";
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) text += "---|";
  for (const Row& row : measurement.rows) {
    text += fmt::format("\n| {} | {} | {:.1f} ({:.1f}..{:.1f}) | {:.1f} |{}", row.what.name, row.loads, row.ms,
                        row.ms_p10, row.ms_p90, row.copy_ratio, errors_of(row));
  }
  const Row& exact = measurement.exact;
  text += fmt::format("\n| exact | all in reach | {:.0f} | {:.0f} |{}\n", exact.ms, exact.copy_ratio, errors_of(exact));
  return text;
}

std::string json_of(const Measurement& measurement, const Subject& subject, const DeviceInfo& device) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Row& row : measurement.rows) rows.push_back(json_row(row, subject));
  rows.push_back(json_row(measurement.exact, subject));
  const nlohmann::ordered_json object = {{"version", DERMIS_VERSION},       {"machine", machine()},
                                         {"device", device.name},           {"driver", device.driver},
                                         {"threads", device.compute_units}, {"picture", subject.name},
                                         {"copy_ms", measurement.copy_ms},  {"rows", rows}};
  return object.dump(2) + "\n";
}

void plot(const std::filesystem::path& path, const Measurement& measurement, const Subject& subject,
          const DeviceInfo& device) {
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot == nullptr) throw Error(ErrorCode::output, "--plot", "no gnuplot", "gnuplot on the PATH");
  const std::string terminal =
      path.extension() == ".png" ? "pngcairo size 1200,800 font ',14'" : "svg size 1100,600 dynamic background 'white'";
  const std::vector<std::string> series = series_of(measurement.rows);
  double least = HUGE_VAL;
  double most = 0;
  for (const Row& row : measurement.rows) {
    for (const double error : row.rel_l2) {
      least = std::min(least, error);
      most = std::max(most, error);
    }
  }
  fmt::print(gnuplot,
             "set terminal {}\nset output '{}'\nset logscale xy\nset xtics (10,15,20,30,40,50,70,100)\nset ytics "
             "(0.003,0.005,0.007,0.01,0.015,0.02,0.03,0.05,0.1)\nset grid\nset xlabel 'time, ms'\n"
             "set ylabel 'relative L2 error against exact'\nset title '{}, {}x{}, {} threads of {}' noenhanced\n"
             "set format y '%g'\nset key outside right font ',10'\n"
             "set yrange [{}:{}]\nset format x '%g'\nplot ",
             terminal, path.string(), subject.name, subject.width, subject.height, device.compute_units, device.name,
             least * 0.9, most * 1.2);
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) {
    for (std::size_t k = 0; k < series.size(); ++k) {
      fmt::print(gnuplot,
                 "{}'-' using 1:2 with linespoints linecolor {} dashtype {} pointtype {} title '{}, {}', "
                 "'-' using 1:2:3 with labels offset 0,0.7 font ',9' notitle",
                 i + k == 0 ? "" : ", ", i + 1, k + 1, 5 + 2 * i, subject.material_names[i], series[k]);
    }
  }
  fmt::print(gnuplot, "\n");
  for (std::size_t i = 0; i < subject.material_names.size(); ++i) {
    for (const std::string& its : series) {
      for (const bool labels : {false, true}) {
        for (const Row& row : measurement.rows) {
          if (row.what.series != its) continue;
          fmt::print(gnuplot, "{} {} {}\n", row.ms, row.rel_l2[i],
                     labels ? std::to_string(row.what.options.taps.count) : "");
        }
        fmt::print(gnuplot, "e\n");
      }
    }
  }
  if (pclose(gnuplot) != 0) throw Error(ErrorCode::output, "--plot", path.string(), "gnuplot to draw it");
}

}  // namespace dermis::bench
