// Figures by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dermis::bench {

/// One curve: points and how gnuplot shall draw them.
struct Curve {
  std::string title;  ///< none if empty
  std::string style;  ///< what follows "with"
  std::vector<std::pair<double, double>> points;
};

/// One set of axes.
struct Panel {
  std::string title;
  std::string settings;  ///< lines for gnuplot: labels, ranges, scales
  std::vector<Curve> curves;
};

/// Colours of red, green and blue curves, and of others.
inline constexpr const char* channel_colours[] = {"#d62728", "#2a8f3c", "#1f5fbf"};
inline constexpr const char* colours[] = {"#d1495b", "#e08e1b", "#2a8f6f", "#2f6db5", "#7a4fa3", "#8a6d4b"};

/// Throws Error(output) if there is no gnuplot.
void need_gnuplot();

/// Panels in `columns` columns as an SVG. Throws Error(output) if it cannot be drawn.
void draw(const std::filesystem::path& path, const std::vector<Panel>& panels, int columns);

}  // namespace dermis::bench
