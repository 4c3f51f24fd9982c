// The pre-integrated filter as one would first write it: a work-item per pixel, importance-sampled taps at the nearest
// pixel, spaced by the pixel's own depth, weights that fall with the difference of depth, none on other materials.
#include "opponents/opencl_passes.hpp"

namespace dermis::bench {

namespace {

constexpr const char* source = R"(
kernel void pass(global const float4* from, global float4* to, global const ushort* material, global const float4* taps,
                 global const float* falloffs_per_mm2, int tap_count, int width, int height, int step_x, int step_y,
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
  const float falloff_per_mm2 = falloffs_per_mm2[mine];
  const float spacing = px_per_mm_falls ? px_per_mm / centre.w : px_per_mm;
  float3 sum = 0;
  float3 weights = 0;
  for (int i = 0; i < tap_count; ++i) {
    const float4 tap = taps[mine * tap_count + i];
    const int offset = convert_int_rte(tap.w * spacing);
    const int tap_x = x + step_x * offset;
    const int tap_y = y + step_y * offset;
    if (tap_x < 0 || tap_x >= width || tap_y < 0 || tap_y >= height) continue;
    const int there = tap_y * width + tap_x;
    if (are_apart(material, here, there)) continue;
    const float4 pixel = from[there];
    const float difference_mm = (pixel.w - centre.w) * mm_per_unit;
    const float3 weight = tap.xyz * fmax(0.0f, 1 - falloff_per_mm2 * difference_mm * difference_mm);
    sum += weight * pixel.xyz;
    weights += weight;
  }
  to[here] = (float4)(sum / weights, centre.w);
}
)";

}  // namespace

std::unique_ptr<Opponent> make_naive(const Case& what, const Scene& scene, const Device& device) {
  const TapsDesign design = {
      .model = Model::pre_integrated, .count = what.design.count, .placement = Placement::importance};
  std::vector<PassTaps> taps;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Profile& profile = scene.materials[m].profile;
    const double pixel_mm = scene.median_pixel_mm(m);
    const TapSet set = make_tap_set(profile, design, pixel_mm, Fetch::linear);
    const double radius_mm = depth_radius_mm(profile);
    taps.push_back({.weights = set.terms.front().weights, .falloff = 1 / (radius_mm * radius_mm)});
    for (const double offset_px : set.offsets_px) taps.back().offsets_mm.push_back(offset_px * pixel_mm);
  }
  return std::make_unique<OpenclPasses>(source, taps, scene, device);
}

}  // namespace dermis::bench
