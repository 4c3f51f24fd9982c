/// What a run of the filter did: the table of --stats and the object of --stats-json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct MaterialReport {
  std::optional<int> id;  ///< none: every pixel
  std::string profile;
  double radius_mm = 0;
  std::int64_t pixels = 0;
  /// Size at the median depth, along the axis that has the smaller ones; none if no pixel is of the material.
  std::optional<double> pixel_mm;
  int widest_px = TapsDesign{}.widest_px;  ///< no kernel is wider, as far as that matters
  std::optional<TapsDesign> design;        ///< none if the method has no taps
  std::optional<int> taps;                 ///< of the design for pixels of that size
  std::optional<double> predicted_rel_l2;  ///< of them, TapSet::predicted_rel_l2
};

/// Wall clock of the steps around the device's own, milliseconds.
struct StepTimes {
  double read_ms = 0;   ///< the file, and the images from it
  double plan_ms = 0;   ///< device opened, kernels built, taps placed
  double run_ms = 0;    ///< the filter, transfers included
  double write_ms = 0;  ///< the file, and the preview
  double total_ms = 0;
};

struct StatsReport {
  DeviceInfo device;
  Options options;
  std::string quality;              ///< empty if another tolerance, a design or a method was asked for
  std::optional<double> tolerance;  ///< if the designs were chosen by it
  Stats stats;
  StepTimes times;
  exr::FoundCamera camera;
  exr::Roles roles;
  std::vector<MaterialReport> materials;
};

std::string text_of(const StatsReport& report);
std::string json_text_of(const StatsReport& report);

}  // namespace dermis::program
