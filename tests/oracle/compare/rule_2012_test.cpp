#include "dermis/oracle/rule_2012.hpp"

#include <cmath>
#include <vector>

#include "dermis/error.hpp"
#include "oracle/support/made_frame.hpp"
#include "support/catch.hpp"

using dermis::Camera;
using dermis::oracle::Picture;
using dermis::oracle::rule_2012;
using dermis::oracle::SliceMaterial;

namespace {

SliceMaterial gaussian(int id) {
  const auto radial = [](int, double r) { return std::exp(-r * r / 2) / (2 * 3.14159265358979); };
  return {.id = id, .radial = radial, .radius_mm = 9};
}

}  // namespace

TEST_CASE("the rule of 2012 weighs by the profile itself, spaced by the depth of the pixel") {
  MadeFrame made(41, 31, Camera::perspective(400, 400, 20.5, 15.5), 0);
  made.depth.assign(made.pixels(), 100);  // There are 4 px per mm.
  MadeFrame::set_rgb(made.light, 15 * 41 + 20, 1, 1, 1);
  const std::vector<SliceMaterial> materials = {gaussian(1)};
  const Picture filtered = rule_2012(made.frame(), materials, 25);
  // Tap i lies at 3 mm (i / 12)^2: that of i = 0 on the pixel, and those of |i| <= 2 within a pixel of it.
  double sum = 0;
  for (int i = -12; i <= 12; ++i) {
    const auto place = [](int k) { return std::copysign(3.0 * k * k / 144, k); };
    sum += (place(std::min(i + 1, 12)) - place(std::max(i - 1, -12))) / 2 * std::exp(-place(i) * place(i) / 2);
  }
  double middle = 0;
  for (int i = -12; i <= 12; ++i) {
    const auto place = [](int k) { return std::copysign(3.0 * k * k / 144, k); };
    const double step = (place(std::min(i + 1, 12)) - place(std::max(i - 1, -12))) / 2;
    middle += step * std::exp(-place(i) * place(i) / 2) / sum * std::max(0.0, 1 - std::abs(4 * place(i)));
  }
  CHECK(filtered(20, 15, 0) == Approx(middle * middle).epsilon(1e-5));
  CHECK(filtered(20, 14, 1) > 0);
  CHECK(filtered(0, 0, 0) == 0);
}

TEST_CASE("the rule of 2012 mixes taps far in front or behind towards the centre, and skips what does not scatter") {
  MadeFrame made(40, 5, Camera::orthographic(4, 4), 0);
  for (std::size_t i = 0; i < made.pixels(); ++i) {
    const bool is_left = i % 40 < 20;
    made.depth.push_back(is_left ? 10 : 30);  // The two are 20 mm apart, which is more than 12.
    made.material.push_back(i / 40 == 4 ? 0 : 1);
    if (is_left) MadeFrame::set_rgb(made.light, i, 1, 0.5, 0);
  }
  const std::vector<SliceMaterial> materials = {gaussian(1)};
  const Picture filtered = rule_2012(made.frame(), materials, 17);
  // The exception is a tap that lies between the two, and takes a part of its light from the other one.
  for (int x = 0; x < 40; ++x)
    CHECK(filtered(x, 1, 0) == Approx(x < 20 ? 1 : 0).margin(x < 10 || x >= 30 ? 1e-6 : 0.01));
  made.depth.assign(made.pixels(), 10);
  const Picture flat = rule_2012(made.frame(), materials, 17);
  CHECK(flat(19, 1, 0) < 0.9);
  CHECK(flat(20, 1, 0) > 0.1);
  CHECK(flat(19, 4, 0) == 1);
  CHECK_THROWS_AS(rule_2012(made.frame(), materials, 4), dermis::Error);
}
