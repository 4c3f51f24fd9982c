#include "report/taps_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "report/gnuplot.hpp"
#include "report/taps_curves.hpp"

namespace dermis::program {
namespace {

constexpr FigureSize figure_size{1560, 960};
constexpr int most_slice_points = 120;
constexpr int most_step_points = 600;
constexpr int shown_singular_values = 12;
constexpr std::array<std::string_view, 3> channel_names = {"R", "G", "B"};
constexpr std::array<std::string_view, 3> pale_colours = {"#f0a8a8", "#a0dca0", "#a8b8f4"};

/// Inline data: x, R, G, B. What a logarithm cannot show is left out.
std::string data(std::string_view name, const Curve& curve, bool logarithmic) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const CurvePoint& point : curve) {
    text += fmt::format("{:.9g}", point.x);
    for (const double value : point.value) text += logarithmic && !(value > 0) ? " NaN" : fmt::format(" {:.9g}", value);
    text += "\n";
  }
  return text + "EOD\n";
}

std::string labels(std::string_view title, std::string_view x, std::string_view y) {
  return fmt::format("set title {} noenhanced font ',13'\nset xlabel {}\nset ylabel {} noenhanced\n",
                     script_string(title), script_string(x), script_string(y));
}

/// One channel of a curve: what it is drawn with, and its name.
std::string line(std::string_view name, std::size_t channel, std::string_view with, std::string_view title) {
  return fmt::format("${} using 1:{} {} title {}", name, channel + 2, with, script_string(title));
}

std::string pale_line(std::size_t channel) {
  return fmt::format("with lines linewidth 6 linecolor rgb '{}'", pale_colours[channel]);
}

std::string thin_line(std::size_t channel) {
  return fmt::format("with lines linewidth 1.5 linecolor rgb '{}'", channel_colours[channel]);
}

/// The truth as wide pale lines, what stands for it as thin ones above.
std::string compare(std::string_view truth, std::string_view truth_name, std::string_view other,
                    std::string_view other_name) {
  std::vector<std::string> lines;
  for (std::size_t c = 0; c < 3; ++c)
    lines.push_back(line(truth, c, pale_line(c), fmt::format("{} {}", channel_names[c], truth_name)));
  for (std::size_t c = 0; c < 3; ++c)
    lines.push_back(line(other, c, thin_line(c), fmt::format("{} {}", channel_names[c], other_name)));
  return fmt::format("plot {}\n", fmt::join(lines, ", "));
}

/// The axis ranges reach from the brightest pixel to a little below where the widest channel ends.
std::string slice_range(const Profile& profile, const Slice& slice) {
  const int widest = profile.widest_channel();
  double highest = 0;
  double lowest = slice.truth.front().value[widest];
  for (const CurvePoint& point : slice.truth) {
    highest = std::max({highest, point.value[0], point.value[1], point.value[2]});
    if (point.value[widest] > 0) lowest = std::min(lowest, point.value[widest]);
  }
  return fmt::format("set yrange [{:.3g}:{:.3g}]\nset xrange [0:*]\n", std::max(lowest / 10, highest * 1e-12),
                     highest * 3);
}

bool has_negative(const Curve& curve) {
  return std::any_of(curve.begin(), curve.end(), [](const CurvePoint& point) {
    return *std::min_element(point.value.begin(), point.value.end()) < 0;
  });
}

std::string slice_panel(std::string_view title, std::string_view distance, const Profile& profile, const Slice& slice,
                        double pixel_mm) {
  const std::string gaps = has_negative(slice.product) ? " (gaps: below zero)" : "";
  return data("truth", slice.truth, true) + data("product", slice.product, true) + slice_range(profile, slice) +
         labels(fmt::format("{}{}", title, gaps), fmt::format("{}, mm (pixels of {:.4g} mm)", distance, pixel_mm),
                "light per area, 1/mm^2") +
         "set logscale y\nset format y '10^{%T}'\nset key top right\n" +
         compare("truth", "profile", "product", "separable") + "unset logscale y\nset format y\n";
}

std::string singular_panel(const Curve& values, std::size_t rank) {
  std::vector<std::string> lines;
  for (std::size_t c = 0; c < 3; ++c)
    lines.push_back(line(
        "values", c,
        fmt::format("with linespoints linewidth 1.5 pointtype 7 pointsize 0.6 linecolor rgb '{}'", channel_colours[c]),
        channel_names[c]));
  // Below this is the rounding of the eigenvalues.
  return data("values", values, true) +
         labels("singular values of the profile on pixels", "number (the line: the rank of the taps)",
                "relative to the first") +
         fmt::format(
             "set logscale y\nset format y '10^{{%T}}'\nset yrange [1e-12:3]\nset xrange [0.5:{0}.5]\nset xtics 1\n"
             "set arrow 1 from {1},graph 0 to {1},graph 1 nohead dashtype 2 linecolor rgb '#808080'\nset key top "
             "right\n"
             "plot {2}\nunset arrow 1\nunset logscale y\nset format y\nset xtics autofreq\n",
             values.size(), rank, fmt::join(lines, ", "));
}

std::string step_panel(const StepResponse& step) {
  return data("edge", step.exact, false) + data("step", step.taps, false) +
         labels("response to a step of light", "distance from the edge, mm", "light") +
         "set yrange [-0.05:1.05]\nset xrange [*:*]\nset key top left\n" + compare("edge", "profile", "step", "taps");
}

std::string step_error_panel(const StepResponse& step) {
  Curve error = step.taps;
  for (std::size_t i = 0; i < error.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) error[i].value[c] = 100 * (error[i].value[c] - step.exact[i].value[c]);
  std::vector<std::string> lines;
  for (std::size_t c = 0; c < 3; ++c) lines.push_back(line("error", c, thin_line(c), channel_names[c]));
  return data("error", error, false) +
         labels("error of the response to the step", "distance from the edge, mm", "taps - profile, % of the step") +
         fmt::format(
             "set yrange [*<-0.01:0.01<*]\nset xrange [*:*]\nset key top left\nplot 0 notitle linecolor rgb '#808080', "
             "{}\n",
             fmt::join(lines, ", "));
}

/// The weights of all terms as impulses, their channels side by side; terms differ in their marks.
std::string weights_panel(const TapSet& set) {
  constexpr std::array marks = {7, 4, 8, 12, 2, 1};
  const double width_px = 2 * set.offsets_px.back() + 1;
  std::string text;
  std::vector<std::string> lines;
  for (std::size_t t = 0; t < set.terms.size(); ++t) {
    Curve curve;
    for (std::size_t i = 0; i < set.offsets_px.size(); ++i) {
      const auto& weight = set.terms[t].weights[i];
      curve.push_back({set.offsets_px[i], {weight[0], weight[1], weight[2]}});
    }
    text += data(fmt::format("term{}", t + 1), curve, false);
    for (std::size_t c = 0; c < 3; ++c) {
      const double shift_px = (static_cast<double>(c) - 1) * std::min(0.25, width_px / 200);
      const std::string columns = fmt::format("$term{} using ($1+{:.4g}):{}", t + 1, shift_px, c + 2);
      const std::string title =
          set.terms.size() == 1 ? std::string(channel_names[c]) : fmt::format("{} term {}", channel_names[c], t + 1);
      lines.push_back(
          fmt::format("{} with impulses linewidth 1.2 linecolor rgb '{}' notitle", columns, channel_colours[c]));
      lines.push_back(fmt::format("{} with points pointtype {} pointsize 0.6 linecolor rgb '{}' title {}", columns,
                                  marks[t % marks.size()], channel_colours[c], script_string(title)));
    }
  }
  return text + labels("weights of the taps", "offset, px", "weight") +
         fmt::format(
             "set yrange [*:*]\nset xrange [{0}:{1}]\nset key top right\nplot 0 notitle linecolor rgb '#808080', {2}\n",
             -0.55 * width_px, 0.55 * width_px, fmt::join(lines, ", "));
}

/// The model alone: taps on every pixel. Pixels are larger where that would be too many.
TapSet dense_set(const Profile& profile, TapsDesign design, double pixel_mm) {
  design.count = 2047;
  const double radius_mm = profile.half_width(profile.widest_channel(), 0.99999);
  return make_tap_set(profile, design, std::max(pixel_mm, radius_mm / (design.count / 2 - 1)));
}

}  // namespace

void plot_taps(std::string_view argument, const std::filesystem::path& path, const Profile& profile,
               const TapsDesign& design, const TapsReport& report) {
  const TapSet dense = dense_set(profile, design, report.set.pixel_mm);
  // A little further than the taps reach.
  const double reach_mm = 1.2 * report.set.offsets_px.back() * report.set.pixel_mm;
  const StepResponse step = step_response(profile, report.set, reach_mm, most_step_points);
  std::string script = fmt::format(
      "set multiplot layout 2,3 title {} noenhanced font ',16'\nset grid linecolor rgb '#dddddd'\nset key opaque\n",
      script_string(title_of(report)));
  script += slice_panel("slice of the kernel along an axis", "distance", profile,
                        axis_slice(profile, dense, most_slice_points), dense.pixel_mm);
  script += slice_panel("slice of the kernel along a diagonal", "distance", profile,
                        diagonal_slice(profile, dense, most_slice_points), dense.pixel_mm);
  script += singular_panel(singular_values(profile, dense, shown_singular_values), report.set.terms.size());
  script += step_panel(step);
  script += step_error_panel(step);
  script += weights_panel(report.set);
  draw_figure(argument, path, figure_size, script + "unset multiplot\n");
}

}  // namespace dermis::program
