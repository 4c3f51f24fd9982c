// Depths in halves are smoothed within what halves round, and no more.
#include <cmath>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using dermis::Format;
using dermis::exr::Picture;
using dermis::exr::Roles;
using Names = std::vector<std::string>;

namespace {

constexpr int width = 60;
constexpr int height = 40;
const Names depth_channel = {"Depth.Z"};

Picture picture_of(const std::vector<float>& depth, Format format) {
  Picture picture({0, 0, width, height}, {0, 0, width, height});
  picture.add_channels(depth_channel, format);
  picture.store(depth_channel, depth, true);
  return picture;
}

std::vector<float> loaded(const Picture& picture) {
  const Roles roles = dermis::exr::find_roles(picture);
  return dermis::exr::load_depth(picture, roles, find_camera(picture, roles, {.focal_px = 100}));
}

}  // namespace

TEST_CASE("the terraces of a depth in halves are smoothed by less than a half rounds") {
  Random random(81);
  const double power = std::exp2(random.integer(0, 9));
  const double step = power / 1024;
  // Two surfaces between a power of 2 and the next, one of them a hundred steps nearer, with background beside.
  const double slope_x = random.uniform(0.2, 0.8);
  const double slope_y = random.uniform(-1, 1);
  const double edge_px = random.uniform(20, 40);
  std::vector<float> depth;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double steps = 300 + slope_x * x + slope_y * y + (x < edge_px ? 0 : 100);
      depth.push_back(y == 0 ? 65504.0F : static_cast<float>(power + steps * step));
    }
  const Picture halves = picture_of(depth, Format::f16);
  const std::vector<float> rounded = halves.plane(depth_channel[0]);
  const std::vector<float> smooth = loaded(halves);
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (i < width) {
      REQUIRE_FALSE(smooth[i] < 1e9F);
      continue;
    }
    // Floats of this size are multiples of step / 8192.
    REQUIRE(std::abs(smooth[i] - rounded[i]) <= step * (0.5 + 1e-3));
    before += std::pow(rounded[i] - depth[i], 2);
    after += std::pow(smooth[i] - depth[i], 2);
  }
  // Rounding is a sawtooth of at most 5 px, as pixels are 1/5 to 4/5 of a step apart along x; the mean over 9 px of it
  // leaves at most a ninth of a period's, and twice that beside edges, where windows are half as wide.
  const auto pixels = static_cast<double>(depth.size() - width);
  CAPTURE(slope_x, slope_y, std::sqrt(before / pixels) / step, std::sqrt(after / pixels) / step);
  CHECK(std::sqrt(after) < std::sqrt(before) / 2);
  const std::vector<float> floats = loaded(picture_of(depth, Format::f32));
  for (std::size_t i = width; i < depth.size(); ++i) REQUIRE(floats[i] == depth[i]);
}
