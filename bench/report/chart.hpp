// A chart of lines and points, as gnuplot shall draw it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace dermis::bench {

struct ChartPoint {
  double x, y;
  std::string label;  ///< beside the point; may be empty
};

struct Series {
  std::string title;
  std::string colour;
  std::string style = "linespoints";  ///< what gnuplot's "with" takes: "linespoints", "points" or "lines"
  int point_type = 7;
  int dash_type = 1;
  double line_width = 1.8;
  bool labels_below = false;
  std::vector<ChartPoint> points = {};
};

struct Chart {
  std::string title, x_title, y_title;
  std::string settings;  ///< further lines for gnuplot: ranges, tics
  std::vector<Series> series = {};
};

/// The lines of a script that draw it, on logarithmic axes.
std::string script_of(const Chart& chart);

}  // namespace dermis::bench
