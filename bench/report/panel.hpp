// Figures of several sets of axes, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::bench {

struct Point {
  double x, y;
  std::string label = {};  ///< beside the point; none if empty
};

/// One curve: points and how gnuplot shall draw them.
struct Curve {
  std::string title;  ///< none if empty
  std::string style;  ///< what follows "with"
  std::vector<Point> points = {};
  std::string label_style = {};  ///< what follows "with labels"; labels are left out if empty

  void add(double x, double y) { points.push_back({x, y}); }
};

/// One set of axes.
struct Panel {
  std::string title;
  std::string settings;  ///< lines for gnuplot: labels, ranges, scales
  std::vector<Curve> curves = {};
};

/// Colours of red, green and blue curves, and of others.
inline constexpr const char* channel_colours[] = {"#d62728", "#2a8f3c", "#1f5fbf"};
inline constexpr const char* colours[] = {"#d1495b", "#e08e1b", "#2a8f6f", "#2f6db5", "#7a4fa3", "#8a6d4b"};

struct PanelSize {
  int width_px = 420;
  int height_px = 380;
};

/// Draws panels in `columns` columns as an SVG; nothing if no panel has points. Throws Error(output) that names
/// `option` if it cannot be drawn.
void draw(std::string_view option, const std::filesystem::path& path, std::vector<Panel> panels, int columns,
          const PanelSize& size = {});

}  // namespace dermis::bench
