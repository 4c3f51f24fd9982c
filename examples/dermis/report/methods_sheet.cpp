#include "report/methods_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

#include "dermis/oracle/compare.hpp"
#include "files/picture_png.hpp"
#include "report/gnuplot.hpp"

namespace dermis::program {
namespace {

/// The error that a map shows brightest, of the mean of the light.
constexpr double brightest_error = 0.1;

oracle::Picture as_picture(int width, int height, const std::vector<float>& values) {
  oracle::Picture picture(width, height, 3);
  std::copy(values.begin(), values.end(), picture.values.begin());
  return picture;
}

/// 1 where two pictures differ.
oracle::Picture changed_pixels(int width, int height, const std::vector<float>& a, const std::vector<float>& b) {
  oracle::Picture changed(width, height, 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) changed.values[i / 3] = 1;
  return changed;
}

/// The mean error of the channels, of the mean of the reference where it counts.
std::vector<float> error_map(const std::vector<float>& values, const std::vector<float>& reference,
                             const oracle::Picture& where) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (where.values[i / 3] == 0) continue;
    sum += std::abs(static_cast<double>(reference[i]));
    ++count;
  }
  const double unit = count > 0 ? sum / count * brightest_error : 1;
  std::vector<float> map(reference.size() / 3);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = std::abs(static_cast<double>(values[i]) - static_cast<double>(reference[i])) / 3 / unit;
    if (where.values[i / 3] != 0) map[i / 3] = std::min(1.0F, map[i / 3] + static_cast<float>(error));
  }
  return map;
}

double relative_l2(int width, int height, const std::vector<float>& a, const std::vector<float>& b,
                   const oracle::Picture& where) {
  return oracle::compare(as_picture(width, height, a), as_picture(width, height, b), where).relative_l2;
}

std::string panel(const std::string& title, const FileInMemory& png) {
  return fmt::format("set title {} offset 0,-0.8\nplot {} binary filetype=png with rgbimage notitle\n",
                     script_string(title), script_string(png.name()));
}

FigureSize sheet_size(int width, int height, std::size_t columns) {
  constexpr int widest_px = 480;
  constexpr int title_px = 30;
  const int panel_px = std::clamp(width, 240, widest_px);
  return {static_cast<int>(columns) * panel_px, 2 * (panel_px * height / width + title_px)};
}

}  // namespace

void draw_methods(std::string_view argument, const std::filesystem::path& path, int width, int height,
                  const std::vector<MethodPicture>& pictures) {
  const bool has_truth = pictures.back().scattered.empty();
  const MethodPicture& truth = pictures.back();
  const MethodPicture& exact = has_truth ? pictures[pictures.size() - 2] : truth;
  const oracle::Picture where = changed_pixels(width, height, exact.scattered, pictures.front().scattered);
  const auto percent_off = [&](const std::vector<float>& a, const std::vector<float>& b) {
    return 100 * relative_l2(width, height, a, b, where);
  };
  std::deque<FileInMemory> files;
  std::string upper;
  std::string lower;
  for (const MethodPicture& picture : pictures) {
    upper += panel(picture.name, files.emplace_back(srgb_png(width, height, picture.beauty)));
    if (picture.scattered.empty()) {
      lower += "set multiplot next\n";
      continue;
    }
    std::vector<std::string> numbers;
    if (&picture != &exact)
      numbers.push_back(fmt::format("{:.2f} % off the exact method", percent_off(picture.scattered, exact.scattered)));
    if (has_truth)
      numbers.push_back(fmt::format("{:.1f} % off the path tracer", percent_off(picture.beauty, truth.beauty)));
    const std::string map = heatmap_png(width, height, error_map(picture.scattered, exact.scattered, where));
    lower += panel(fmt::format("{}", fmt::join(numbers, ", ")), files.emplace_back(map));
  }
  const std::string script = fmt::format(
      "unset tics\nunset border\nunset key\nset size ratio -1\nset margins 0.5,0.5,0.2,1.6\n"
      "set xrange [0:{}]\nset yrange [0:{}]\nset multiplot layout 2,{}\n{}{}unset multiplot\n",
      width - 1, height - 1, pictures.size(), upper, lower);
  draw_figure(argument, path, sheet_size(width, height, pictures.size()), script);
}

}  // namespace dermis::program
