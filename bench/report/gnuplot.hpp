// Pictures by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::bench {

/// Throws Error(output) that names `option` if there is no gnuplot.
void need_gnuplot(std::string_view option);

/// A string of a gnuplot script.
std::string gnuplot_string(std::string_view text);

/// Runs a script that draws one SVG of that size. Throws Error(output) that names `option`.
void draw_svg(std::string_view option, const std::filesystem::path& path, int width_px, int height_px,
              const std::string& script);

}  // namespace dermis::bench
