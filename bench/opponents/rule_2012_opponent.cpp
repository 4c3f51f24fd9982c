// The rules that real-time shaders of 2012 follow (Jimenez and Gutierrez, Separable Subsurface Scattering, report
// RR-02-12), in a kernel of a work-item per pixel: the radial profile itself as one-dimensional weights, quadratic
// spacing, linear interpolation of light and nearest depth, and taps off the surface mixed towards the centre. Lengths
// are those of skin; of other materials they are as much longer as their profiles are wider.
#include <algorithm>
#include <cmath>

#include "opponents/opencl_passes.hpp"

namespace dermis::bench {

namespace {

/// The kernel's reach in skin, mm: 2 for up to 20 taps, else 3, so that the look depends on the quality.
double reach_mm(int count) { return count > 20 ? 3 : 2; }

/// The difference of depth in skin, mm, from which a tap counts as the centre. The rule is min(1, 300 d w |dz|) with d
/// the distance to the projection window and w the width in scene units that 3 mm are; with the demo's lens of 20
/// degrees (d = 5.67) and w = 0.012 it reaches 1 at dz = 4.1 w = 12 mm.
constexpr double full_mix_mm = 12;

constexpr const char* source = R"(
kernel void pass(global const float4* from, global float4* to, global const ushort* material, global const float4* taps,
                 global const float* mixes_per_mm, int tap_count, int width, int height, int step_x, int step_y,
                 float px_per_mm, int px_per_mm_falls, float mm_per_unit) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const int here = y * width + x;
  const float4 centre = from[here];
  const int mine = material_of(material, here, centre.w);
  if (mine == no_material) {
    to[here] = centre;
    return;
  }
  global const float4* its_taps = taps + mine * tap_count;
  const float mix_per_mm = mixes_per_mm[mine];
  const float spacing = px_per_mm_falls ? px_per_mm / centre.w : px_per_mm;
  const int at = step_x ? x : y;
  const int last = (step_x ? width : height) - 1;
  const int stride = step_x ? 1 : width;
  const int line = step_x ? y * width : x;
  float3 sum = its_taps[tap_count / 2].xyz * centre.xyz;
  for (int i = 0; i < tap_count; ++i) {
    if (i == tap_count / 2) continue;
    const float4 tap = its_taps[i];
    const float position = clamp(at + tap.w * spacing, 0.0f, (float)last);
    const int low = (int)position;
    const int high = min(low + 1, last);
    const float part = position - low;
    const float4 a = from[line + low * stride];
    const float4 b = from[line + high * stride];
    const float depth = part < 0.5f ? a.w : b.w;
    const float towards_centre = fmin(1.0f, mix_per_mm * mm_per_unit * fabs(depth - centre.w));
    sum += tap.xyz * mix(mix(a.xyz, b.xyz, part), centre.xyz, towards_centre);
  }
  to[here] = (float4)(sum, centre.w);
}
)";

PassTaps slice_taps(const Profile& profile, int count) {
  const double width = width_over_skin(profile);
  PassTaps taps = {.falloff = 1 / (width * full_mix_mm)};
  const double reach = width * reach_mm(count);
  for (int i = 0; i < count; ++i) {
    const double even = reach * (2.0 * i / (count - 1) - 1);
    taps.offsets_mm.push_back(std::copysign(even * even / reach, even));
  }
  std::array<double, 3> sum{};
  std::vector<std::array<double, 3>> weights(taps.offsets_mm.size());
  for (int i = 0; i < count; ++i) {
    const double before = taps.offsets_mm[std::max(i - 1, 0)];
    const double after = taps.offsets_mm[std::min(i + 1, count - 1)];
    for (int c = 0; c < 3; ++c) {
      constexpr double middle_mm = 1e-6;  // Profile::radial wants a distance above 0
      weights[i][c] = (after - before) / 2 * profile.radial(c, std::max(std::abs(taps.offsets_mm[i]), middle_mm));
      sum[c] += weights[i][c];
    }
  }
  for (const std::array<double, 3>& weight : weights) {
    taps.weights.push_back({static_cast<float>(weight[0] / sum[0]), static_cast<float>(weight[1] / sum[1]),
                            static_cast<float>(weight[2] / sum[2])});
  }
  return taps;
}

}  // namespace

std::unique_ptr<Opponent> make_rule_2012(const Case& what, const Scene& scene, const Device& device) {
  std::vector<PassTaps> taps;
  for (const Material& material : scene.materials) taps.push_back(slice_taps(material.profile, what.design.count));
  return std::make_unique<OpenclPasses>(source, taps, scene, device);
}

}  // namespace dermis::bench
