#include "stress/rows.hpp"

#include <random>

#include "stress/cases.hpp"

namespace dermis::bench {

std::vector<StressRow> stress_rows(const Device& device, std::uint32_t seed, const StressProgress& progress) {
  const auto report = [&](const char* what) {
    if (progress) progress(what);
  };
  std::mt19937 engine(seed);
  const std::vector<Material> materials = {{0, preset("skin").profile}};
  std::vector<StressRow> rows;
  report("stress: light, frames");
  const StressFilter flat(device, materials, {});
  add_light_cases(rows, flat, engine);
  add_frame_cases(rows, flat, engine);
  report("stress: depth, cameras");
  const StressFilter deep(device, materials, {.depth = true});
  add_depth_cases(rows, deep, engine);
  add_camera_cases(rows, deep, engine);
  report("stress: light that is not finite");
  add_bad_light_cases(rows, device, deep, engine);
  report("stress: every method");
  add_method_cases(rows, device, engine);
  report("stress: profiles of any width");
  add_width_cases(rows, device, engine);
  return rows;
}

}  // namespace dermis::bench
