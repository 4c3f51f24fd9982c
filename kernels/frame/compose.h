// The outputs of V pixels. Pixels that did not scatter keep the bits of the input.
#include "frame/load.h"

typedef struct {
  global const uchar* beauty;
  global uchar *scattered, *result;
  struct ImageParams beauty_at, scattered_at, result_at;
  int writes_scattered, writes_result;
  int zeroes_bad;
} Outputs;

#if HAS_MATTE
// `share` of what comes after, the rest of what was before.
static inline vrgb blended(vrgb before, vrgb after, vfloat share) {
  const vrgb more = {after.r - before.r, after.g - before.g, after.b - before.b};
  return select_rgb(sum_rgb(before, times(more, share)), after, AS_MASK(share >= 1.0f));
}
#endif

// `after`: the light after scattering; not looked at where a pixel takes none. `all_finite`: all that is read is.
SHARED void compose(const struct FrameParams* f, const Inputs* in, const InputRows* rows, const Outputs* out,
                    vrgb after, int all_finite, int x, int y) {
  const vint inside = AS_MASK(x + int_lane_numbers() < (vint)(f->width));
  const vint m = load_bytes(rows->material_ids + x);
  if (!HAS_MATTE && all_finite && !out->writes_result && !any_bit(AS_MASK(m == 0) | AS_MASK((m & NARROW_BIT) != 0))) {
    if (out->writes_scattered) write_rgb(out->scattered, &out->scattered_at, x, y, after, inside);
    return;
  }
  const vrgb input = read_rgb(&rows->light, x);
  const vrgb albedo = read_albedo(rows, x);
  const vrgb before = scattering_light(f, input, albedo);
  const vint bad = bad_lanes(m, input, albedo, before);
  const vint touched = AS_MASK(m != 0) & AS_MASK((m & NARROW_BIT) == 0) & ~bad;
  const vint zeroed = out->zeroes_bad ? bad : (vint)(0);
#if HAS_MATTE
  after = blended(before, after, read_values(rows->matte, x));
#endif
  if (out->writes_result) {
    copy_rgb(out->beauty, &out->beauty_at, out->result, &out->result_at, f->width, x, y, inside & ~touched);
    if (any_bit(touched)) {
      const RgbRow beauty_row = rgb_row_of(out->beauty, &out->beauty_at, f->width, y);
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
      write_rgb(out->result, &out->result_at, x, y, sum_rgb(beauty, change), inside & touched);
    }
    if (any_bit(zeroed)) write_rgb(out->result, &out->result_at, x, y, broadcast_rgb((vfloat)(0.0f)), zeroed);
  }
  if (out->writes_scattered) {
    vint written = inside;
#if !LIT
    if (f->albedo_mix == 0.0f && in->light_at.format == FORMAT_F16) {
      // A half that is no number would come out as another one.
      const vint kept = inside & ~touched & ~zeroed;
      copy_rgb(in->light, &in->light_at, out->scattered, &out->scattered_at, f->width, x, y, kept);
      written &= ~kept;
    }
#endif
    write_rgb(out->scattered, &out->scattered_at, x, y, select_or_zero_rgb(~zeroed, select_rgb(before, after, touched)),
              written);
  }
}
