// A measurement as a table, as JSON and as a plot of time against error.
#pragma once

#include <filesystem>
#include <string>

#include "measure.hpp"

namespace dermis::bench {

/// A Markdown table, with the machine above it.
std::string table_of(const Measurement& measurement, const Subject& subject, const DeviceInfo& device);

/// An object with machine, device, driver, version and rows.
std::string json_of(const Measurement& measurement, const Subject& subject, const DeviceInfo& device);

/// Time against error of every row, by gnuplot, as SVG or PNG by the file's name. Throws Error(output) if it cannot be
/// drawn.
void plot(const std::filesystem::path& path, const Measurement& measurement, const Subject& subject,
          const DeviceInfo& device);

}  // namespace dermis::bench
