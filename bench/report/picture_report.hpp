// A measurement as a table, as JSON and as a plot of time against error.
#pragma once

#include <filesystem>
#include <string>

#include "measure/picture_measurement.hpp"

namespace dermis::bench {

/// A Markdown table, with the machine above it.
std::string table_of(const PictureMeasurement& measurement, const Subject& subject, const DeviceInfo& device);

/// An object with machine, device, driver, version and rows.
std::string json_of(const PictureMeasurement& measurement, const Subject& subject, const DeviceInfo& device);

/// Time against error of every row, as SVG. Throws Error(output) if it cannot be
/// drawn.
void plot(const std::filesystem::path& path, const PictureMeasurement& measurement, const Subject& subject,
          const DeviceInfo& device);

}  // namespace dermis::bench
