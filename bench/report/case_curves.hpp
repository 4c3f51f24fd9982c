// The cases of a measurement as curves.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/measurement.hpp"
#include "report/panel.hpp"

namespace dermis::bench {

/// Settings of all panels that show a measurement.
inline constexpr const char* axes =
    "set logscale xy\nset border 3\nset tics nomirror\nset key outside right top font ',12'\n";
inline constexpr const char* round_tics = "(0.1,0.2,0.5,1,2,5,10,20,50,100,200,500,1000,2000,5000)";
inline constexpr PanelSize panel_size = {860, 480};

using Choice = std::function<bool(const Row&)>;
using Value = std::function<double(const Row&)>;

std::string line_style(std::string_view colour, int point_type, int dash_type = 1);
std::string label_style(std::string_view colour, bool is_below = false);
bool by_x(const Point& a, const Point& b);

/// Whether the row is one of a frame of floats, on all threads, with taps that are the same at every pixel.
bool is_default_caller(const Row& row);

/// The rows that `belongs` picks: one curve per method (dermis: per rank), in the order of the rows.
std::vector<Curve> curves_of(const Measurement& measurement, const Choice& belongs, const Value& x, const Value& y,
                             const std::function<std::string(const Row&)>& label);

}  // namespace dermis::bench
