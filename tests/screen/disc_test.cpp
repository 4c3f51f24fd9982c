// How near discs come to the integral that they sample, and what they must not do.
#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "dermis/oracle/compare.hpp"
#include "dermis/oracle/scenes.hpp"
#include "dermis/plan.hpp"
#include "inputs/natural_picture.hpp"
#include "support/catch.hpp"
#include "support/compare_light.hpp"
#include "support/natural_pictures.hpp"
#include "support/random_frame.hpp"

using dermis::Device;
using dermis::DiscOptions;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::Profile;
namespace oracle = dermis::oracle;

namespace {

Options discs(const DiscOptions& disc, std::uint32_t seed = 0) {
  return {.method = Method::disc, .disc = disc, .seed = seed};
}

/// A natural picture per channel on a card parallel to the screen, one pixel to the millimetre, and around it the same
/// pictures again, in pixels that give light but take none. Burley's profile has a standard deviation of 16 px along an
/// axis in red; green and blue are narrower in the ratios of skin.
class NaturalCard {
 public:
  explicit NaturalCard(int side_px) : side_px_(side_px), whole_px_(side_px + 2 * margin_px) {
    for (int c = 0; c < 3; ++c) {
      const std::vector<double> picture = dermis::bench::natural_picture(side_px, 11 + static_cast<std::uint32_t>(c));
      light_[c] = picture;
      truth_[c] = convolved(picture, c);
    }
    for (int y = 0; y < whole_px_; ++y) {
      for (int x = 0; x < whole_px_; ++x) {
        for (int c = 0; c < 3; ++c)
          image_.push_back(static_cast<float>(light_[c][inside(x - margin_px, y - margin_px)]));
        const bool takes_light = std::min(x, y) >= margin_px && std::max(x, y) < margin_px + side_px;
        mask_.push_back(takes_light ? 1.0F : 1e-6F);
      }
    }
  }

  oracle::Picture filtered(const Options& options) const {
    std::vector<float> scattered(image_.size());
    Frame frame{.width = whole_px_, .height = whole_px_, .camera = dermis::Camera::orthographic(1, 1)};
    frame.light = {.host = image_.data()};
    frame.mask = {.host = mask_.data()};
    frame.scattered = {.host = scattered.data()};
    const dermis::Stats stats =
        Plan(Device::open(), {{.profile = profile_}}, FrameDescription::of(frame), options).run(frame);
    CHECK(stats.pixels_scattered == side_px_ * side_px_);
    oracle::Picture picture(side_px_, side_px_, 3);
    for (int y = 0; y < side_px_; ++y) {
      for (int x = 0; x < side_px_; ++x) {
        const std::size_t at = static_cast<std::size_t>(y + margin_px) * whole_px_ + x + margin_px;
        for (int c = 0; c < 3; ++c) picture(x, y, c) = static_cast<double>(scattered[3 * at + c]);
      }
    }
    return picture;
  }

  /// Returns the relative L2 distance of all channels together from the convolution with the profile on pixels.
  double error_of(const oracle::Picture& picture) const { return oracle::compare(picture, of(truth_)).relative_l2; }
  double error_of(const Options& options) const { return error_of(filtered(options)); }
  double error_unfiltered() const { return error_of(of(light_)); }

  /// Returns how far the mean over the picture is from that of the light, relative to it.
  double change_of_mean(const oracle::Picture& picture) const {
    double change = 0;
    double total = 0;
    const oracle::Picture before = of(light_);
    for (std::size_t i = 0; i < before.values.size(); ++i) {
      change += picture.values[i] - before.values[i];
      total += before.values[i];
    }
    return std::abs(change) / total;
  }

 private:
  using Channels = std::array<std::vector<double>, 3>;
  using Spectrum = std::vector<std::complex<double>>;
  static constexpr int margin_px = 128;  ///< None of 128 samples lies farther than 95 px.

  std::size_t inside(int x, int y) const {
    const auto wrapped = [&](int i) { return (i % side_px_ + side_px_) % side_px_; };
    return static_cast<std::size_t>(wrapped(y)) * side_px_ + wrapped(x);
  }

  oracle::Picture of(const Channels& channels) const {
    oracle::Picture picture(side_px_, side_px_, 3);
    for (std::size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = channels[i % 3][i / 3];
    return picture;
  }

  void transform(Spectrum& values, int direction) const {
    auto* data = reinterpret_cast<fftw_complex*>(values.data());
    const fftw_plan plan = fftw_plan_dft_2d(side_px_, side_px_, data, data, direction, FFTW_ESTIMATE);
    fftw_execute(plan);
    fftw_destroy_plan(plan);
  }

  /// Convolves a picture with the profile: its mean over each pixel up to 6 px, beyond them its value in the middle.
  /// What lies beyond 512 px is 1e-18 of it.
  std::vector<double> convolved(const std::vector<double>& picture, int c) const {
    constexpr int near_px = 6;
    constexpr int far_px = 512;
    Spectrum kernel(picture.size());
    double total = 0;
    for (int y = -far_px; y <= far_px; ++y) {
      for (int x = -far_px; x <= far_px; ++x) {
        const double value = std::max(std::abs(x), std::abs(y)) <= near_px
                                 ? profile_.rectangle(c, x - 0.5, x + 0.5, y - 0.5, y + 0.5)
                                 : profile_.radial(c, std::hypot(x, y));
        kernel[inside(x, y)] += value;
        total += value;
      }
    }
    Spectrum values(picture.begin(), picture.end());
    transform(kernel, FFTW_FORWARD);
    transform(values, FFTW_FORWARD);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= kernel[i] / total;
    transform(values, FFTW_BACKWARD);
    std::vector<double> result;
    for (const auto& value : values) result.push_back(value.real() / static_cast<double>(picture.size()));
    return result;
  }

  int side_px_, whole_px_;
  Profile profile_ = Profile::burley({16 / std::sqrt(7.0), 6 / std::sqrt(7.0), 3 / std::sqrt(7.0)});
  Channels light_, truth_;
  std::vector<float> image_, mask_;
};

}  // namespace

// The bounds are what bilinear disc samples are known to reach. Measured: 0.044, 0.021 and 0.011, prefiltered 0.019,
// 0.0076 and 0.0038.
TEST_CASE("discs of 21, 55 and 128 samples on natural pictures", "[disc]") {
  const NaturalCard card(128);
  CHECK(card.error_unfiltered() > 0.2);
  for (const auto& [samples, bound] : {std::pair{21, 0.045}, {55, 0.023}, {128, 0.013}}) {
    const double error = card.error_of(discs({.samples = samples}));
    const double prefiltered = card.error_of(discs({.samples = samples, .prefiltered = true}));
    CAPTURE(samples, error, prefiltered);
    CHECK(error <= bound);
    CHECK(2 * prefiltered <= error);
  }
}

// Random points would take four times as many for half the error; points that are spread evenly do better.
TEST_CASE("more samples come ever closer to the convolution", "[disc]") {
  const NaturalCard card(96);
  for (const bool prefiltered : {false, true}) {
    double before = card.error_of(discs({.samples = 16, .prefiltered = prefiltered}));
    const double first = before;
    for (const int samples : {64, 256, 1024}) {
      const double error = card.error_of(discs({.samples = samples, .prefiltered = prefiltered}));
      CAPTURE(prefiltered, samples, error, before);
      CHECK(error < before / 2);
      before = error;
    }
    const double slope = std::log(before / first) / std::log(1024.0 / 16);
    CAPTURE(prefiltered, slope, before);
    CHECK(slope < -0.65);
    CHECK(before < 0.003);
  }
}

// With b the error of the mean over infinitely many seeds and s what one seed scatters about it, one result is off by
// b^2 + s^2 and the mean of 16 by b^2 + s^2 / 16.
TEST_CASE("rotation leaves the mean over seeds unchanged", "[disc]") {
  const NaturalCard card(96);
  constexpr int seeds = 16;
  const oracle::Picture one = card.filtered(discs({.samples = 128}));
  const oracle::Picture mean = card.filtered(discs({.samples = 128, .accumulate = seeds}));
  const double error_of_one = card.error_of(one);
  const double error_of_mean = card.error_of(mean);
  const double bias_squared = (seeds * error_of_mean * error_of_mean - error_of_one * error_of_one) / (seeds - 1);
  CAPTURE(error_of_one, error_of_mean, bias_squared);
  CHECK(card.change_of_mean(one) <= 1e-3);
  CHECK(card.change_of_mean(mean) <= 1e-3);
  CHECK(error_of_mean < error_of_one / 3);
  CHECK(bias_squared <= 1e-6);
}

namespace {

const std::vector<dermis::Material>& three_materials() {
  static const std::vector<dermis::Material> materials{{1, dermis::preset("skin").profile},
                                                       {2, dermis::preset("marble").profile},
                                                       {3, Profile::burley({0.4, 0.3, 0.8})}};
  return materials;
}

std::vector<float> filtered(const oracle::Scene& scene, const Options& options, dermis::Stats* stats = nullptr) {
  std::vector<float> scattered(scene.light.size());
  Frame frame = scene.frame();
  frame.albedo = {};
  frame.beauty = {};
  frame.scattered = {.host = scattered.data()};
  const dermis::Stats its = Plan(Device::open(), three_materials(), FrameDescription::of(frame), options).run(frame);
  if (stats != nullptr) *stats = its;
  return scattered;
}

}  // namespace

TEST_CASE("on surfaces too discs come ever closer to the exact integral", "[disc]") {
  const oracle::Scene scene = oracle::scene("head", 64, 60, 3);
  const std::vector<float> exact = filtered(scene, {.method = Method::exact});
  CHECK(relative_l2(scene.light, exact) > 0.03);
  for (const bool tangent_plane : {false, true}) {
    const double few = relative_l2(filtered(scene, discs({.samples = 32, .tangent_plane = tangent_plane})), exact);
    const double many = relative_l2(filtered(scene, discs({.samples = 1024, .tangent_plane = tangent_plane})), exact);
    CAPTURE(tangent_plane, few, many);
    CHECK(few < 0.03);
    CHECK(many < few / 5);
    CHECK(many < 0.003);
  }
}

TEST_CASE("accumulated discs are the mean over seeds", "[disc]") {
  const oracle::Scene scene = oracle::scene("sphere", 45, 31, 3);
  const std::vector<float> together = filtered(scene, discs({.samples = 9, .accumulate = 3}, 7));
  std::vector<float> mean(together.size());
  for (const std::uint32_t seed : {7U, 8U, 9U}) {
    const std::vector<float> one = filtered(scene, discs({.samples = 9}, seed));
    CHECK((one != together));
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / 3;
  }
  CHECK(relative_l2(together, mean) < 1e-6);
}

TEST_CASE("no material takes light of another through blocks of pixels or between pixels", "[disc]") {
  const oracle::Scene scene = oracle::scene("touching", 121, 90, 4);
  for (const bool prefiltered : {false, true}) {
    const std::vector<float> scattered = filtered(scene, discs({.samples = 40, .prefiltered = prefiltered}));
    double changed = 0;
    for (std::size_t i = 0; i < scene.material.size(); ++i) {
      // One material is lit red, the other one blue.
      const std::size_t dark = scene.light[3 * i] > 0 ? 2 : 0;
      REQUIRE(scene.light[3 * i + dark] == 0);
      REQUIRE(scattered[3 * i + dark] == 0);
      changed =
          std::max(changed, static_cast<double>(std::abs(scattered[3 * i + 2 - dark] - scene.light[3 * i + 2 - dark])));
    }
    CHECK(changed > 0.01);
  }
}

TEST_CASE("a pixel whose light is not finite gives discs none", "[disc]") {
  oracle::Scene scene = oracle::scene("tilted", 60, 50, 4);
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const std::size_t at = 25 * 60 + 30;
    scene.light[3 * at + 1] = bad;
    for (const bool prefiltered : {false, true}) {
      const std::vector<float> scattered = filtered(scene, discs({.samples = 40, .prefiltered = prefiltered}));
      for (std::size_t i = 0; i < scattered.size(); ++i) REQUIRE((i / 3 == at || std::isfinite(scattered[i])));
      CHECK((scattered != scene.light));
    }
  }
}

namespace {

/// A checkered card of 90 x 90 pixels, made of skin.
class CheckeredCard {
 public:
  explicit CheckeredCard(int samples) : plan_(Device::open(), {{.profile = skin_}}, {}, discs({.samples = samples})) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) light_.insert(light_.end(), 3, (x / 5 + y / 5) % 2 == 0 ? 1.0F : 0.1F);
    }
  }

  /// Returns the light after scattering at the scale at which the kernel has that radius.
  std::vector<float> at(double radius_px) {
    std::vector<float> scattered(light_.size());
    const double px_per_mm = radius_px / skin_.half_width(skin_.widest_channel(), 0.999);
    Frame frame{.width = side, .height = side, .camera = dermis::Camera::orthographic(px_per_mm, px_per_mm)};
    frame.light = {.host = light_.data()};
    frame.scattered = {.host = scattered.data()};
    stats = plan_.run(frame);
    return scattered;
  }

  /// Returns the largest relative change of the picture from one scale to the next, which is 2 % larger.
  double largest_change(double from_px, double to_px) {
    constexpr double step = 1.02;
    double largest = 0;
    std::vector<float> before = at(from_px);
    for (double radius_px = from_px * step; radius_px < to_px; radius_px *= step) {
      std::vector<float> after = at(radius_px);
      largest = std::max(largest, relative_l2(after, before));
      before = std::move(after);
    }
    return largest;
  }

  dermis::Stats stats;

 private:
  static constexpr int side = 90;
  Profile skin_ = dermis::preset("skin").profile;
  Plan plan_;
  std::vector<float> light_;
};

}  // namespace

TEST_CASE("kernels in a pixel are left alone, those in 4 x 4 pixels have 21 samples, wide ones 55", "[disc]") {
  CheckeredCard by_width(0);
  CheckeredCard few(21);
  CheckeredCard all(55);
  by_width.at(0.49);
  CHECK(by_width.stats.pixels_narrow == by_width.stats.pixels);
  CHECK((by_width.at(0.6) == few.at(0.6)));
  CHECK((by_width.at(1.99) == few.at(1.99)));
  CHECK((by_width.at(1.99) != all.at(1.99)));
  CHECK((by_width.at(3.01) == all.at(3.01)));
  CHECK((by_width.at(2.5) != all.at(2.5)));
}

// Where the number of samples stays the same, the picture changes a little with each step of the scale. Where it
// changes, from none to few and from few to all, it must not change much more than that.
TEST_CASE("no level of detail pops", "[disc]") {
  CheckeredCard by_width(0);
  CheckeredCard few(21);
  CheckeredCard all(55);
  const double all_the_same = all.largest_change(1.9, 3.1);
  const double few_to_all = by_width.largest_change(1.9, 3.1);
  const double none_to_few = by_width.largest_change(0.48, 0.6);
  const double pop = relative_l2(few.at(2.5), all.at(2.5));
  CAPTURE(all_the_same, few_to_all, none_to_few, pop);
  CHECK(few_to_all < all_the_same + pop / 10);
  CHECK(few_to_all < 0.75 * pop);
  CHECK(none_to_few < 1e-3);
}

TEST_CASE("discs skip pixels without light within reach", "[disc]") {
  oracle::Scene scene = oracle::scene("impulse", 257, 89, 3);
  dermis::Stats stats;
  const std::vector<float> scattered = filtered(scene, discs({}), &stats);
  CAPTURE(stats.pixels_unlit, stats.pixels_scattered);
  CHECK(stats.pixels_unlit > stats.pixels / 4);
  CHECK(stats.pixels_unlit < stats.pixels_scattered);
  CHECK(stats.tiles.kinds.empty());
  CHECK(relative_l2(scattered, scene.light) > 0.1);
  // Skipped pixels have the light that they would have.
  scene.light[0] = std::numeric_limits<float>::min();
  scene.light[3 * (88 * 257 + 256)] = std::numeric_limits<float>::min();
  CHECK(relative_l2(scattered, filtered(scene, discs({}))) < 1e-30);
  for (float& value : scene.light) value = 0;
  filtered(scene, discs({}), &stats);
  CHECK(stats.pixels_unlit == stats.pixels_scattered);
}

TEST_CASE("a normal image turns the disc as depth would", "[disc]") {
  const oracle::Scene scene = oracle::scene("tilted", 80, 60, 4);
  const std::vector<float> by_depth = filtered(scene, discs({.samples = 64}));
  std::vector<float> by_normal(scene.light.size());
  std::vector<float> normals = scene.normal;
  const auto run = [&] {
    Frame frame = scene.frame();
    frame.albedo = {};
    frame.beauty = {};
    frame.normal = {.host = normals.data()};
    frame.scattered = {.host = by_normal.data()};
    Plan(Device::open(), three_materials(), FrameDescription::of(frame), discs({.samples = 64})).run(frame);
    return relative_l2(by_normal, by_depth);
  };
  CHECK(run() < 1e-3);
  for (std::size_t i = 0; i < normals.size(); i += 3) normals[i] = -3 * normals[i];
  CHECK(run() > 1e-3);  // it is looked at
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = -scene.normal[i];
  run();
  CHECK((by_depth == by_normal));  // it faces away
}
