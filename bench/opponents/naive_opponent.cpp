// The pre-integrated filter as one would first write it: a work-item per pixel, importance-sampled taps at the nearest
// pixel, spaced by the pixel's own depth, weights that fall with the difference of depth.
#include "opponents/opencl_passes.hpp"

namespace dermis::bench {

namespace {

constexpr const char* source = R"(
kernel void pass(global const float4* from, global float4* to, global const float4* taps, int tap_count, int width,
                 int height, int step_x, int step_y, float px_per_mm, int px_per_mm_falls, float mm_per_unit,
                 float falloff_per_mm2) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  const int here = y * width + x;
  const float4 centre = from[here];
  if (centre.w >= 1e9f) {
    to[here] = centre;
    return;
  }
  const float spacing = px_per_mm_falls ? px_per_mm / centre.w : px_per_mm;
  float3 sum = 0;
  float3 weights = 0;
  for (int i = 0; i < tap_count; ++i) {
    const float4 tap = taps[i];
    const int offset = convert_int_rte(tap.w * spacing);
    const int tap_x = x + step_x * offset;
    const int tap_y = y + step_y * offset;
    if (tap_x < 0 || tap_x >= width || tap_y < 0 || tap_y >= height) continue;
    const float4 pixel = from[tap_y * width + tap_x];
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
  const double pixel_mm = 1 / scene.px_per_mm();
  const TapsDesign design = {
      .model = Model::pre_integrated, .count = what.design.count, .placement = Placement::importance};
  const TapSet set = make_tap_set(skin(), design, pixel_mm, Fetch::linear);
  PassTaps taps;
  for (const double offset_px : set.offsets_px) taps.offsets_mm.push_back(offset_px * pixel_mm);
  taps.weights = set.terms.front().weights;
  const double radius_mm = 3.3 * skin_width_mm;  // where weights reach 0
  return std::make_unique<OpenclPasses>(source, taps, static_cast<float>(1 / (radius_mm * radius_mm)), scene, device);
}

}  // namespace dermis::bench
