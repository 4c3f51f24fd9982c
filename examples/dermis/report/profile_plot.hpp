/// Curves of profiles, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "dermis/profile.hpp"

namespace dermis::program {

/// Draws R(r) 2 pi r of each channel over r, one panel per preset, to an .svg or .png file. `argument` is named in
/// errors. Throws Error(output) if gnuplot is missing or fails.
void plot_profiles(std::string_view argument, const std::filesystem::path& path, std::span<const Preset> presets);

}  // namespace dermis::program
