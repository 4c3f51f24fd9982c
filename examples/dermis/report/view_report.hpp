/// A picture that shows where views have brought light, and from which of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/frame.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

struct ViewReport {
  std::vector<float> light;               ///< scattered over what the camera sees, packed RGB
  std::vector<std::vector<float>> gains;  ///< the light that each view alone brings, RGB; negative where it takes some
};

/// Runs a plan on the frame without its views, and with each of them alone. Writes no output of the frame.
ViewReport measure_views(const Plan& plan, const Frame& frame);

/// A line for each view: its colour, and the pixels whose light it changes by a hundredth and more.
std::string legend_of(const ViewReport& report, const std::vector<std::string>& names);

/// The PNG file of the scattered light in grey, and over it, the stronger the more the views bring, the colours of
/// these by how much each brings. Throws Error(output).
std::string view_report_png(int width, int height, const ViewReport& report);

}  // namespace dermis::program
