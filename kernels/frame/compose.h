// Writes the outputs of V pixels. Pixels that did not scatter keep the bits of the input.
#include "frame/load.h"

typedef struct {
  const struct FrameLayouts* layouts;
  const struct RunFlags* flags;
  global uchar *scattered, *result;
} FrameOutputs;

#if HAS_MATTE
// Blends: 0 gives `before`, 1 the bits of `after`.
static inline vrgb blended(vrgb before, vrgb after, vfloat share) {
  const vrgb more = {after.r - before.r, after.g - before.g, after.b - before.b};
  return select_rgb(sum_rgb(before, times(more, share)), after, AS_MASK(share >= 1.0f));
}
#endif

// `after` is the light after scattering, which is not read where a pixel takes none. `all_finite` says that the light
// and the albedo of all pixels with a material are finite.
SHARED void compose(const struct FrameParams* f, const FrameInputs* in, const InputRows* rows, const FrameOutputs* out,
                    vrgb after, int all_finite, int x, int y) {
  const struct FrameLayouts* layouts = out->layouts;
  const struct RunFlags* flags = out->flags;
  const vint inside = AS_MASK(x + int_lane_numbers() < (vint)(f->width));
  const vint m = load_bytes(rows->material_ids + x);
  if (!HAS_MATTE && all_finite && !flags->writes_result && !any_bit(AS_MASK(m == 0) | AS_MASK((m & NARROW_BIT) != 0))) {
    if (flags->writes_scattered) write_rgb(out->scattered, &layouts->scattered, x, y, after, inside);
    return;
  }
  const vrgb input = read_rgb(&rows->light, x);
  const vrgb albedo = read_albedo(rows, x);
  const vrgb before = scattering_light(f, input, albedo);
  const vint bad = bad_lanes(m, input, albedo, before);
  const vint touched = AS_MASK(m != 0) & AS_MASK((m & NARROW_BIT) == 0) & ~bad;
  const vint zeroed = flags->zeroes_bad ? bad : (vint)(0);
#if HAS_MATTE
  after = blended(before, after, read_values(rows->matte, x));
#endif
  if (flags->writes_result) {
    copy_rgb(in->beauty, &layouts->beauty, out->result, &layouts->result, f->width, x, y, inside & ~touched);
    if (any_bit(touched)) {
      const RgbRow beauty_row = rgb_row_of(in->beauty, &layouts->beauty, f->width, y);
      const vrgb beauty = read_rgb(&beauty_row, x);
      vrgb change;
#if !LIT
      if (f->albedo_mix == 0.0f) {
        const vrgb more = {after.r - before.r, after.g - before.g, after.b - before.b};
        change = product(albedo, more);
      } else
#endif
      {
        const vrgb diffuse = diffuse_part(input, albedo);
        const vrgb whole = product(albedo_power(albedo, 1.0f - f->albedo_mix), after);
        change.r = whole.r - diffuse.r;
        change.g = whole.g - diffuse.g;
        change.b = whole.b - diffuse.b;
      }
      write_rgb(out->result, &layouts->result, x, y, sum_rgb(beauty, change), inside & touched);
    }
    if (any_bit(zeroed)) write_rgb(out->result, &layouts->result, x, y, broadcast_rgb((vfloat)(0.0f)), zeroed);
  }
  if (flags->writes_scattered) {
    vint written = inside;
#if !LIT
    if (f->albedo_mix == 0.0f && layouts->light.format == FORMAT_F16) {
      // A half that is NaN would come out as another NaN.
      const vint kept = inside & ~touched & ~zeroed;
      copy_rgb(in->light, &layouts->light, out->scattered, &layouts->scattered, f->width, x, y, kept);
      written &= ~kept;
    }
#endif
    write_rgb(out->scattered, &layouts->scattered, x, y,
              select_or_zero_rgb(~zeroed, select_rgb(before, after, touched)), written);
  }
}
