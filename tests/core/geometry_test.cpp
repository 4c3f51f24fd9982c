// How far the passes are from the surface integral where a surface is curved, tilted and broken.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "dermis/oracle/scenes.hpp"
#include "dermis/plan.hpp"

namespace oracle = dermis::oracle;
using dermis::Device;
using dermis::Frame;
using dermis::FrameDescription;
using dermis::Material;
using dermis::Method;
using dermis::Options;
using dermis::Plan;
using dermis::TapsDesign;

namespace {

constexpr int dense = 401;  // taps on every pixel within reach

/// A scene under its true light, and which of its pixels count.
struct Subject {
  oracle::Scene scene;
  std::vector<Material> materials;
  std::vector<float> truth;
  std::vector<double> facing;  ///< cosine between normal and view; -1 where a pixel is not of the foreground
  double mean = 0;             ///< of the true light of the foreground
};

std::vector<float> filtered(const Subject& subject, const Options& options) {
  std::vector<float> scattered(subject.scene.light.size());
  Frame frame = subject.scene.frame();
  frame.albedo = {};
  frame.beauty = {};
  frame.scattered = {.host = scattered.data()};
  Plan(Device::open(), subject.materials, FrameDescription::of(frame), options).run(frame);
  return scattered;
}

/// `farthest_mm`: what lies behind is not of the foreground.
Subject make_subject(const char* name, std::vector<Material> materials, double farthest_mm) {
  Subject subject{oracle::scene(name, 280, 250, 4), std::move(materials), {}, {}};
  const oracle::Scene& scene = subject.scene;
  subject.truth = filtered(subject, {.method = Method::exact});
  int pixels = 0;
  for (std::size_t i = 0; i < scene.depth.size(); ++i) {
    const float* n = &scene.normal[3 * i];
    const float* p = &scene.position[3 * i];
    const float length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const bool counts = scene.material[i] > 0 && scene.depth[i] < static_cast<float>(farthest_mm);
    subject.facing.push_back(counts ? static_cast<double>(-(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / length) : -1);
    if (!counts) continue;
    ++pixels;
    for (int c = 0; c < 3; ++c) subject.mean += static_cast<double>(subject.truth[3 * i + c]);
  }
  subject.mean /= 3 * pixels;
  return subject;
}

/// Root mean square errors over the mean.
struct Errors {
  double foreground = 0;
  double tilted = 0;  ///< where the cosine between normal and view is 0.25..0.6
  double worst = 0;   ///< of any value
};

Errors errors(const Subject& subject, const Options& options) {
  const std::vector<float> scattered = filtered(subject, options);
  Errors errors;
  int tilted = 0;
  int all = 0;
  for (std::size_t i = 0; i < subject.facing.size(); ++i) {
    if (subject.facing[i] < 0) continue;
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto off = static_cast<double>(scattered[3 * i + c] - subject.truth[3 * i + c]);
      squares += off * off;
      errors.worst = std::max(errors.worst, std::abs(off) / subject.mean);
    }
    errors.foreground += squares;
    all += 3;
    if (subject.facing[i] < 0.25 || subject.facing[i] > 0.6) continue;
    errors.tilted += squares;
    tilted += 3;
  }
  errors.foreground = std::sqrt(errors.foreground / all) / subject.mean;
  errors.tilted = std::sqrt(errors.tilted / tilted) / subject.mean;
  return errors;
}

const Subject& two_spheres() {
  static const Subject subject = make_subject("spheres", {{1, dermis::preset("skin").profile}}, 210);
  return subject;
}

const Subject& head() {
  static const Subject subject = make_subject("head",
                                              {{1, dermis::preset("skin").profile},
                                               {2, dermis::preset("marble").profile},
                                               {3, dermis::preset("wax").profile}},
                                              1e9);
  return subject;
}

Options design(int rank, int count) { return {.taps = {.rank = rank, .count = count}}; }

}  // namespace

TEST_CASE("a sphere before another one is scattered as its surface", "[geometry]") {
  struct Row {
    Options options;
    Errors bound;
  };
  for (const Row& row : {Row{design(2, dense), {0.008, 0.006, 0.30}}, Row{design(1, 17), {0.014, 0.014, 0.30}},
                         Row{design(2, 17), {0.010, 0.010, 0.30}}}) {
    const Errors its = errors(two_spheres(), row.options);
    CAPTURE(row.options.taps.rank, row.options.taps.count, its.foreground, its.tilted, its.worst);
    CHECK(its.foreground <= row.bound.foreground);
    CHECK(its.tilted <= row.bound.tilted);
    CHECK(its.worst <= row.bound.worst);
  }
}
TEST_CASE("head x", "[geometry]") {
  struct Row {
    Options options;
    Errors bound;
  };
  for (const Row& row : {Row{design(2, dense), {0.008, 0.006, 0.30}}, Row{design(1, 17), {0.014, 0.014, 0.30}},
                         Row{design(2, 17), {0.010, 0.010, 0.30}}}) {
    const Errors its = errors(head(), row.options);
    CAPTURE(row.options.taps.rank, row.options.taps.count, its.foreground, its.tilted, its.worst);
    CHECK(its.foreground <= 1e-9*row.bound.foreground);
  }
}
