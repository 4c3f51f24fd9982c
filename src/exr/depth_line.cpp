#include "exr/depth_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "exr/median.hpp"

namespace dermis::exr {
namespace {

constexpr int turns = 10;

DepthLine line_of(std::span<const double> expected, std::span<const float> depth,
                  const std::vector<std::size_t>& rows) {
  const auto n = static_cast<double>(rows.size());
  double x = 0;
  double y = 0;
  for (const std::size_t i : rows) {
    x += expected[i] / n;
    y += static_cast<double>(depth[i]) / n;
  }
  double square = 0;
  double product = 0;
  for (const std::size_t i : rows) {
    square += (expected[i] - x) * (expected[i] - x);
    product += (expected[i] - x) * (static_cast<double>(depth[i]) - y);
  }
  const double factor = square > 0 ? product / square : 0;
  return {.offset = y - factor * x, .factor = factor};
}

}  // namespace

DepthLine depth_line(std::span<const double> expected, std::span<const float> depth) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < depth.size(); ++i) rows.push_back(i);
  DepthLine line;
  for (int turn = 0; turn < turns; ++turn) {
    line = line_of(expected, depth, rows);
    std::vector<double> errors;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      errors.push_back(std::abs(line.offset + line.factor * expected[i] - static_cast<double>(depth[i])));
      sizes.push_back(std::abs(line.factor * expected[i]));
    }
    const double typical = median(errors);
    line.off = typical / std::max(median(std::move(sizes)), 1e-300);
    rows.clear();
    for (std::size_t i = 0; i < depth.size(); ++i)
      if (errors[i] <= 2 * typical) rows.push_back(i);
  }
  return line;
}

}  // namespace dermis::exr
