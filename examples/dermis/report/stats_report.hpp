/// The table of --stats and the object of --stats-json, which tell what a run of the filter did.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct MaterialReport {
  std::optional<int> id;            ///< none: every pixel
  std::optional<std::string> name;  ///< in a Cryptomatte
  std::string profile;
  double radius_mm = 0;
  std::int64_t pixels = 0;
  /// Size at the median depth, along the axis that has the smaller ones; none if no pixel is of the material.
  std::optional<double> pixel_mm;
  std::optional<MaterialTaps> taps;  ///< for pixels of that size; none if the method has no taps
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
  Options asked;    ///< with the quality or the tolerance that was asked for
  Options options;  ///< as chosen
  Stats stats;
  StepTimes times;
  exr::FoundCamera camera;
  exr::Roles roles;
  std::vector<MaterialReport> materials;
  std::vector<std::string> views;     ///< the files of stats.views
  std::vector<std::string> input;     ///< what was taken from the picture, as printed
  std::vector<std::string> notes;     ///< as printed
  std::vector<std::string> warnings;  ///< as printed
};

std::string text_of(const StatsReport& report);

nlohmann::json json_of(const StatsReport& report);

/// An object for one view, or {"views": [...]} for several.
std::string json_text_of(const std::vector<StatsReport>& views);

}  // namespace dermis::program
