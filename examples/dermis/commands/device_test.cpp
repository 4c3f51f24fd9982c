#include "commands/device_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "dermis/dermis.hpp"
#include "dermis/oracle/materials.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "report/stopwatch.hpp"

namespace dermis::program {
namespace {

using Oracle = oracle::Reference (*)(const Frame&, std::span<const oracle::Material>, const Options&);

std::vector<Material> test_materials() {
  return {{1, preset("skin").profile}, {2, preset("marble").profile}, {3, preset("wax").profile}};
}

/// The largest error over what float32 may be off, of a scene filtered on a device.
double worst_of(const Device& device, const oracle::Scene& scene, Method method, Oracle truth) {
  const std::vector<Material> materials = test_materials();
  Options options{.taps = {.rank = 2, .count = 9}};
  options.method = method;
  options.disc.samples = 21;
  std::vector<float> scattered(scene.light.size());
  Frame frame = scene.frame();
  frame.scattered = {.host = scattered.data()};
  const oracle::Reference expected = truth(frame, oracle::materials_of(materials, options.taps), options);
  Plan(device, materials, FrameDescription::of(frame), options).run(frame);
  double worst = 0;
  for (std::size_t i = 0; i < scattered.size(); ++i) {
    const double off = std::abs(static_cast<double>(scattered[i]) - expected.scattered.values[i]);
    if (off == 0) continue;
    const double share = off / expected.scattered_bound.values[i];
    worst = std::isnan(share) ? std::numeric_limits<double>::infinity() : std::max(worst, share);
  }
  return worst;
}

}  // namespace

DeviceTest test_device(const std::string& name) try {
  Stopwatch stopwatch;
  const oracle::Scene scene = oracle::scene("head", 53, 37, 2);
  const Device device = Device::open(name);
  const double separable = worst_of(device, scene, Method::separable, oracle::separable);
  const double disc = worst_of(device, scene, Method::disc, oracle::disc);
  const bool passed = separable <= 1 && disc <= 1;
  return {passed, fmt::format("{}: separable {:.2g}, disc {:.2g} of what float32 may be off; {:.1f} s",
                              passed ? "right" : "WRONG", separable, disc, stopwatch.lap_ms() / 1000)};
} catch (const Error& error) {
  return {false, std::string("REFUSED: ") + error.what()};
}

}  // namespace dermis::program
