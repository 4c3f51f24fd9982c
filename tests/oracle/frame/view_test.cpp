#include "oracle/frame/view.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/random.hpp"

namespace dermis::oracle {

namespace {

View random_view(Random& random) {
  const auto projection = random.coin() ? Camera::Projection::perspective : Camera::Projection::orthographic;
  return {
      Camera{projection, random.uniform(5, 50), random.uniform(5, 50), random.uniform(-9, 9), random.uniform(-9, 9)},
      random.uniform(0.5, 20)};
}

}  // namespace

TEST_CASE("a camera projects to where it unprojects from", "[view]") {
  const Camera lens = Camera::perspective(30, 40, 3, 4);
  const Vec3 seen = View(lens, 10).unproject(13, 2, 60);
  CHECK(seen[0] == Approx(20));
  CHECK(seen[1] == Approx(-3));
  CHECK(30 * seen[0] / seen[2] + 3 == Approx(13));
  const Vec3 flat = View(Camera::orthographic(4, 8), 10).unproject(2, 2, 60);
  CHECK(flat[0] == Approx(5));
  CHECK(flat[1] == Approx(2.5));
  CHECK(flat[2] == 60);
}

TEST_CASE("points a millimetre apart are as many pixels apart as there are pixels per mm", "[view]") {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const View view = random_view(random);
    const double z = random.uniform(1, 30);
    const Vec3 here = view.unproject(3, 5, z);
    CHECK(view.px_per_mm(horizontal, exact(z)).value == Approx(1 / (view.unproject(4, 5, z)[0] - here[0])));
    CHECK(view.px_per_mm(vertical, exact(z)).value == Approx(1 / (view.unproject(3, 6, z)[1] - here[1])));
  }
}

TEST_CASE("tangents are the change of position per pixel", "[view]") {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    const View view = random_view(random);
    const double x = random.uniform(-9, 9);
    const double y = random.uniform(-9, 9);
    const double z = random.uniform(5, 30);
    const double slope = random.uniform(-2, 2);
    const double step = 1e-5;
    for (const Axis axis : {horizontal, vertical}) {
      const double dx = axis == horizontal ? step : 0;
      const Vec3 ahead = view.unproject(x + dx, y + step - dx, z + step * slope);
      const Vec3 behind = view.unproject(x - dx, y - step + dx, z - step * slope);
      const Vec3 tangent = view.tangent(axis, x, y, z, slope);
      for (std::size_t c = 0; c < 3; ++c) CHECK(tangent[c] == Approx((ahead[c] - behind[c]) / (2 * step)).margin(1e-6));
    }
  }
}

TEST_CASE("the position of a pixel is that of its centre", "[view]") {
  Random random(3);
  const View view = random_view(random);
  const Vec3 point = view.unproject(7.5, 2.5, 12);
  const auto position = view.position(7, 2, exact(12));
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(position[c].value == Approx(point[c]).margin(1e-12));
    CHECK(position[c].error < 1e-5 * (9 + std::abs(point[c])));
  }
}

}  // namespace dermis::oracle
