/// Figures, drawn by gnuplot.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace dermis::program {

/// The colours of red, green and blue curves, as a script names them.
inline constexpr std::array<std::string_view, 3> channel_colours = {"#c02020", "#209020", "#2040c0"};

/// A string of a gnuplot script.
std::string script_string(std::string_view text);

/// Size of a figure, and what else its terminal is told, as "dynamic font 'Helvetica,14'".
struct FigureSize {
  int width_px;
  int height_px;
  std::string_view terminal_options = {};
};

/// Throws Error(output) that names `argument` if there is no gnuplot.
void need_gnuplot(std::string_view argument);

/// Runs a script of one page whose output is an .svg or .png file; the script sets neither terminal nor output.
/// `argument` is named in errors. Throws Error(output) if gnuplot is missing or fails, Error(usage) for a name that no
/// script can hold.
void draw_figure(std::string_view argument, const std::filesystem::path& path, const FigureSize& size,
                 const std::string& script);

}  // namespace dermis::program
