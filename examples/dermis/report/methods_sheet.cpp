#include "report/methods_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dermis/oracle/compare.hpp"
#include "files/picture_png.hpp"
#include "report/contact_sheet.hpp"

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
  std::vector<SheetCell> cells;
  for (const MethodPicture& picture : pictures)
    cells.push_back({picture.name, srgb_png(width, height, picture.beauty)});
  for (const MethodPicture& picture : pictures) {
    if (picture.scattered.empty()) {
      cells.emplace_back();
      continue;
    }
    std::vector<std::string> numbers;
    if (&picture != &exact)
      numbers.push_back(fmt::format("{:.2f} % off the exact method", percent_off(picture.scattered, exact.scattered)));
    if (has_truth)
      numbers.push_back(fmt::format("{:.1f} % off the path tracer", percent_off(picture.beauty, truth.beauty)));
    cells.push_back({fmt::format("{}", fmt::join(numbers, ", ")),
                     heatmap_png(width, height, error_map(picture.scattered, exact.scattered, where))});
  }
  draw_sheet(argument, path, width, height, static_cast<int>(pictures.size()), cells);
}

}  // namespace dermis::program
