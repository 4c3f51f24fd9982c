/// The report of `dermis taps` on a set of taps: for people, as JSON, as rows.
#pragma once

#include <string>

#include "dermis/taps.hpp"

namespace dermis::program {

struct TapsReport {
  std::string profile;  ///< as the command line has it, without folders
  TapsDesign design;
  bool width_follows_albedo = false;
  TapSet set;
};

/// Pixels read and loaded again by both passes: the horizontal one reads one image, the vertical one an image per term.
int loads_per_pixel(const TapSet& set);

/// An offset as text: whole ones without a point.
std::string offset_text(double offset_px);

/// A line about profile, design and predicted error.
std::string title_of(const TapsReport& report);

std::string table_of(const TapsReport& report);
std::string json_text_of(const TapsReport& report);
std::string csv_of(const TapsReport& report);

}  // namespace dermis::program
