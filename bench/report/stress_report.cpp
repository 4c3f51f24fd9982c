#include "report/stress_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "report/gnuplot.hpp"
#include "report/panel.hpp"
#include "stress/sums.hpp"

namespace dermis::bench {

namespace {

constexpr std::uint32_t seed = 1;

/// The text of a cell; empty where a number does not apply.
std::string cell(double value) { return std::isnan(value) ? "" : fmt::format("{:.2g}", value); }

std::string table_of(const std::vector<StressRow>& rows) {
  std::string table =
      "| case | rel. L2 | max rel. | max ulp | error / bound | energy | overshoot | not finite | promised | holds |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const StressRow& row : rows) {
    table +=
        fmt::format("| {}: {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.group, row.name, cell(row.rel_l2),
                    cell(row.max_rel), cell(row.max_ulp), cell(row.of_bound), cell(row.energy), cell(row.overshoot),
                    row.non_finite, row.promised, row.holds() ? "yes" : "**no**: " + row.failure);
  }
  return table;
}

std::string table_of(const std::vector<SumRow>& rows) {
  std::string table = "| mean |";
  std::string rule = "|---|";
  for (const int size : sum_sizes) {
    table += fmt::format(" {} values |", size);
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (const SumRow& row : rows) {
    table += "| " + row.how + " |";
    for (std::size_t s = 0; s < sum_sizes.size(); ++s)
      table += fmt::format(" {:.1e} ({:.1e}) |", row.rms[s], row.max[s]);
    table += "\n";
  }
  return table;
}

constexpr double least_shown = 1e-9;

/// One number of each case of a group; cases stand below each other.
Curve curve_of(const std::vector<StressRow>& rows, const char* title, const char* colour, int point,
               double StressRow::*number) {
  Curve curve{title, fmt::format("points lc rgb '{}' pt {} ps 0.9 lw 1.5", colour, point)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = rows[i].*number;
    if (std::isnan(value)) continue;
    curve.add(std::max(value, least_shown), -static_cast<double>(i));
  }
  return curve;
}

Panel panel_of(const std::string& group, const std::vector<StressRow>& rows) {
  std::string names;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    names += fmt::format("{}'{}' -{}", i == 0 ? "" : ", ", rows[i].name, i);
  }
  Panel panel{
      group,
      fmt::format(
          "set logscale x\nset xrange [{}:1]\nset yrange [{}:0.5]\nset format x '10^{{%T}}'\n"
          "set xtics 1e-9, 1000 font ',11'\nset ytics ({}) font ',9'\nset lmargin 25\nset rmargin 2\n"
          "set xlabel 'error (left edge: 1e-9 or less)' font ',11' offset 0,0.6\nset key below maxrows 2 font ',10'",
          least_shown / 2, -static_cast<double>(rows.size()) + 0.5, names)};
  panel.curves.push_back(curve_of(rows, "relative L2", colours[0], 7, &StressRow::rel_l2));
  panel.curves.push_back(curve_of(rows, "energy", colours[3], 9, &StressRow::energy));
  panel.curves.push_back(curve_of(rows, "largest relative", colours[1], 4, &StressRow::max_rel));
  panel.curves.push_back(
      {"4e-6", "lines lc rgb '#444444' dt 2", {{4e-6, 0.5}, {4e-6, -static_cast<double>(rows.size()) + 0.5}}});
  return panel;
}

Panel panel_of(const std::vector<SumRow>& rows) {
  Panel panel{"weighted means on the host, six decades of light",
              "set logscale xy\nset xrange [12:3000]\nset yrange [1e-8:1e-1]\nset format y '10^{%T}'\n"
              "set xtics (17, 65, 257, 2000) font ',11'\nset ytics font ',11'\n"
              "set xlabel 'values' font ',11' offset 0,0.6\nset ylabel 'relative error, rms' font ',11'\n"
              "set key below maxrows 3 font ',10'"};
  constexpr std::array shown = {"rounded once, from double", "in order", "16 lanes", "Kahan",
                                "half values, float sums",   "half sums"};
  for (const SumRow& row : rows) {
    const auto* const place = std::find(shown.begin(), shown.end(), row.how);
    if (place == shown.end()) continue;
    Curve curve{row.how, fmt::format("linespoints lc rgb '{}' pt {} ps 0.6 lw 1.5", colours[place - shown.begin()],
                                     place - shown.begin() + 4)};
    for (std::size_t s = 0; s < sum_sizes.size(); ++s) curve.add(sum_sizes[s], row.rms[s]);
    panel.curves.push_back(curve);
  }
  return panel;
}

void draw_figure(const std::filesystem::path& path, const std::vector<StressRow>& rows,
                 const std::vector<SumRow>& sums) {
  std::vector<std::string> groups;
  for (const StressRow& row : rows) {
    const bool has_error = !std::isnan(row.rel_l2) || !std::isnan(row.energy);
    if (has_error && std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
  }
  std::vector<Panel> panels;
  for (const std::string& group : groups) {
    std::vector<StressRow> of_group;
    for (const StressRow& row : rows) {
      if (row.group == group && !(std::isnan(row.rel_l2) && std::isnan(row.energy))) of_group.push_back(row);
    }
    panels.push_back(panel_of(group, of_group));
  }
  panels.push_back(panel_of(sums));
  draw("--plot", path, panels, 2, {.width_px = 640, .height_px = 440});
}

}  // namespace

std::string stress_report(const Device& device, const std::string& plot_folder, const StressProgress& progress) {
  if (!plot_folder.empty()) program::need_gnuplot("--plot");
  const std::vector<StressRow> rows = stress_rows(device, seed, progress);
  progress("stress: sums on the host");
  const std::vector<SumRow> sums = study_sums(seed);
  if (!plot_folder.empty()) draw_figure(std::filesystem::path(plot_folder) / "stress.svg", rows, sums);
  const auto broken = std::count_if(rows.begin(), rows.end(), [](const StressRow& row) { return !row.holds(); });
  return fmt::format(
      "# Numerical stress on {}\n\n"
      "Errors are those of the separable method from the same taps summed in double precision. Energy is the relative "
      "change of light that is the same everywhere, or of the sum over impulses. Promises: relative L2, the oracle's "
      "bound on every value, change of white light. {} of {} hold.\n\n{}\n"
      "## Weighted means in float on the host\n\n"
      "Root mean square of the relative error (and the largest), {} decades of light, weights above 0.\n\n{}",
      device.info().name, rows.size() - static_cast<std::size_t>(broken), rows.size(), table_of(rows), 6,
      table_of(sums));
}

}  // namespace dermis::bench
