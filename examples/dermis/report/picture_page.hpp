/// --report: a page to look at a picture before and after the filter, in any browser.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/stats_report.hpp"

namespace dermis::program {

/// What a page shows of a frame, no larger than a screen has pixels for.
struct PageImages {
  int width;
  int height;
  std::vector<float> before;     ///< scene-linear RGB
  std::vector<float> after;      ///< scene-linear RGB
  std::vector<float> radius_px;  ///< of the kernel, in pixels of the frame; 0 where nothing scatters
  std::vector<float> blocks;     ///< as tile_map draws them; or empty
};

/// Images of the frame's size, the last one of which may be empty.
PageImages page_images(int width, int height, std::span<const float> before, std::span<const float> after,
                       std::span<const float> radius_px, std::span<const float> blocks);

/// The HTML file, with its pictures in it. Throws Error(output).
std::string picture_page(const std::string& title, const std::string& command, const PageImages& images,
                         const StatsReport& report);

}  // namespace dermis::program
