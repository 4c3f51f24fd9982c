// disc sums light from importance-sampled points of a disc about each pixel (Golubev 2018),
//     M(p) = (own E(p) + sum a_i J_i R(|P_p - P_i|) E_i) / (own + sum a_i J_i R(|P_p - P_i|)),
// where sample i stands for the area a_i of the disc, J_i is how much more surface than disc there is under it, and own
// is the light that stays on the pixel, where no sample reads.
#pragma OPENCL FP_CONTRACT OFF
#include "base/rotation.h"
#include "integral/own_share.h"

#if V != 1
#error "V: samples of a pixel lie anywhere, so that it is alone"
#endif

// Up to one kernel radius, px, a pixel reads few samples, and from the other one on all. Between them it reads both and
// blends.
#define FEW_RADIUS_PX 2.0f
#define ALL_RADIUS_PX 3.0f

// A disc is tilted no more than this, as change of depth per change of place on the screen: the samples of one that is
// seen edge on would lie on a line, whatever the surface does beside it.
#define STEEPEST 0.75f

// No sample is farther from its pixel, px.
#define FARTHEST_PX 131072.0f

// The view of a plane about a pixel. Its axes are mm along the plane, at right angles.
typedef struct {
  float x_x, x_y, y_x, y_y;  // px along x for each mm along either axis, and along y
  float px_per_mm;           // the root of the determinant
  float inner_mm;            // the disc that the pixel contains
} Disc;

// The disc in the plane in which a pixel spans x and y (Gram and Schmidt).
static inline Disc disc_of(Vectors x, Vectors y) {
  const float length_x = sqrt(squared_length(x));
  const float along = fma(x.x, y.x, fma(x.y, y.y, x.z * y.z)) / length_x;
  const float area = patch_area(x, y);
  const float across = area / length_x;
  const float length_y = sqrt(squared_length(y));
  const Disc disc = {1.0f / length_x, -along / area,     0.0f,
                     1.0f / across,   1.0f / sqrt(area), 0.5f * area / fmax(length_x, length_y)};
  return disc;
}

// Turns the axes of a disc.
static inline Disc turned(Disc d, float2 turn) {
  const Disc result = {fma(d.x_x, turn.x, d.x_y * turn.y),
                       fma(d.x_y, turn.x, -d.x_x * turn.y),
                       fma(d.y_x, turn.x, d.y_y * turn.y),
                       fma(d.y_y, turn.x, -d.y_x * turn.y),
                       d.px_per_mm,
                       d.inner_mm};
  return result;
}

// A pixel that takes light, and the texels that its samples read.
typedef struct {
  const struct FrameParams* f;
  const struct TexelLevels* levels;
  global const struct TexelParams* texels;
  int x, y;
  int material;  // 1 + index
  Points p;
  Profile profile;
  float width;  // factor by which the widest channel is wider
  Disc disc;
  vrgb own;  // share of the light that stays on the pixel
  vrgb own_light;
} Pixel;

// The surface under a sample: sums over the texels that it touches, by its share on each.
typedef struct {
  vrgb light;  // times area
  float area;  // per px, times share
  float rise;  // depth less that of the pixel, times share
  float share;
} Reading;

// Reads texels of 2^level pixels a side, (x, y) pixels away: the four about that point, by the share of a square of
// side 1 / `sharpness` texels that lies on each side of the lines between them. The pixel itself has no share. Returns
// 0 if one of them, of texels larger than a pixel, is not all of the material or holds the pixel itself.
SHARED int read_level(Reading* reading, const Pixel* pixel, int level, float sharpness, float x, float y) {
  const float size_px = (float)(1 << level);
  const float to_texels = 1.0f / size_px;
  const int width = pixel->f->width >> level;
  const int height = pixel->f->height >> level;
  const int own_x = pixel->x >> level;
  const int own_y = pixel->y >> level;
  // The middle of the texel that holds the pixel.
  const float middle_x = ((float)(own_x << level) + 0.5f * size_px) - ((float)pixel->x + 0.5f);
  const float middle_y = ((float)(own_y << level) + 0.5f * size_px) - ((float)pixel->y + 0.5f);
  const float u = (x - middle_x) * to_texels;
  const float v = (y - middle_y) * to_texels;
  const float column = floor(u);
  const float row = floor(v);
  const float right = clamp(fma(u - column - 0.5f, sharpness, 0.5f), 0.0f, 1.0f);
  const float below = clamp(fma(v - row - 0.5f, sharpness, 0.5f), 0.0f, 1.0f);
  global const struct TexelParams* texels = pixel->texels + pixel->levels->first[level];
  const Reading nothing = {broadcast_rgb(0.0f), 0.0f, 0.0f, 0.0f};
  *reading = nothing;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float share = (i == 0 ? 1.0f - right : right) * (j == 0 ? 1.0f - below : below);
      if (share == 0.0f) continue;
      const int across = (int)column + i;
      const int down = (int)row + j;
      const int its_x = own_x + across;
      const int its_y = own_y + down;
      const int is_inside = its_x >= 0 && its_y >= 0 && its_x < width && its_y < height;
      const int is_own = across == 0 && down == 0;
      global const struct TexelParams* texel = texels + (is_inside ? (size_t)its_y * width + its_x : 0);
      if (!is_inside || is_own || texel->material != pixel->material) {
        if (level > 0) return 0;
        continue;
      }
      const float to_x = x - fma((float)across, size_px, middle_x);
      const float to_y = y - fma((float)down, size_px, middle_y);
      const float rise = fma(to_x, texel->slope_x, fma(to_y, texel->slope_y, texel->depth - pixel->p.z));
      const float area = share * texel->area;
      reading->light.r = fma(area, texel->light[0], reading->light.r);
      reading->light.g = fma(area, texel->light[1], reading->light.g);
      reading->light.b = fma(area, texel->light[2], reading->light.b);
      reading->area += area;
      reading->rise = fma(share, rise, reading->rise);
      reading->share += share;
    }
  }
  return 1;
}

// The level whose texels are as large as the part of the disc that a sample stands for, or just below.
static inline int level_of(const struct TexelLevels* levels, float spacing_px) {
  const int exponent = (as_int(spacing_px) >> 23) - 127;
  return clamp(exponent, 0, levels->count - 1);
}

static inline Reading read_at(const Pixel* pixel, float spacing_px, float x, float y) {
  Reading reading;
  for (int level = level_of(pixel->levels, spacing_px); level > 0; --level) {
    if (read_level(&reading, pixel, level, (float)(1 << level) / spacing_px, x, y)) return reading;
  }
  read_level(&reading, pixel, 0, 1.0f / fmax(spacing_px, FLT_MIN), x, y);
  return reading;
}

// Squared true distance to the point (x, y) pixels away that lies so much deeper.
static inline float squared_distance_to(const struct FrameParams* f, const Points* p, float x, float y, float rise) {
  const float z = p->z + rise;
  const float across = fma(p->x_per_z, rise, x * fma(z, f->slope_x, f->mm_per_px_x));
  const float down = fma(p->y_per_z, rise, y * fma(z, f->slope_y, f->mm_per_px_y));
  return fma(across, across, fma(down, down, rise * rise));
}

// Light and its weight.
typedef struct {
  vrgb light;
  vrgb weight;
} Sum;

// Adds the samples of a set on a disc.
static inline void add_samples(Sum* sum, const Pixel* pixel, Disc d, global const struct SampleParams* samples,
                               int count) {
  const vrgb per_area = product(pixel->profile.reciprocal, pixel->profile.reciprocal);
  for (int i = 0; i < count; ++i) {
    const struct SampleParams sample = samples[i];
    const float a = pixel->width * sample.x_mm;
    const float b = pixel->width * sample.y_mm;
    const float x = clamp(fma(d.x_x, a, d.x_y * b), -FARTHEST_PX, FARTHEST_PX);
    const float y = clamp(fma(d.y_x, a, d.y_y * b), -FARTHEST_PX, FARTHEST_PX);
    const float spacing_px = pixel->width * sample.spacing_mm * d.px_per_mm;
    const Reading reading = read_at(pixel, spacing_px, x, y);
    if (reading.share == 0.0f) continue;
    const float r_squared = squared_distance_to(pixel->f, &pixel->p, x, y, reading.rise / reading.share);
    const vrgb density = product(radial_at(&pixel->profile, r_squared), per_area);
    const vrgb weight = times(density, spacing_px * spacing_px);
    sum->weight = sum_rgb(sum->weight, times(weight, reading.area));
    sum->light = multiply_add(weight, reading.light, sum->light);
  }
}

// The mean over all seeds, of few or all samples.
static inline vrgb gather(const Pixel* pixel, global const struct DiscParams* its,
                          global const struct SampleParams* samples, const struct DiscCounts* counts, int which,
                          global const float2* turns) {
  const Disc d = pixel->disc;
  const vrgb own_light = pixel->own_light;
  int start = 0;
  while (start + 1 < DISC_STARTS && d.inner_mm >= pixel->width * its->inner_mm[which][start + 1]) ++start;
  const int count = counts->samples[which];
  global const struct SampleParams* set = samples + its->first_sample[which] + start * count;
  vrgb mean = broadcast_rgb(0.0f);
  for (int i = 0; i < counts->seeds; ++i) {
    const float2 turn = turns[rotation_index(pixel->x, pixel->y + pixel->f->first_row, counts->seed + i)];
    Sum sum = {product(pixel->own, own_light), pixel->own};
    add_samples(&sum, pixel, turned(d, turn), set, count);
#if SUMS_WEIGHTS
    mean = sum_rgb(mean, sum.light);
#else
    mean.r += sum.weight.r > 0.0f ? sum.light.r / sum.weight.r : own_light.r;
    mean.g += sum.weight.g > 0.0f ? sum.light.g / sum.weight.g : own_light.g;
    mean.b += sum.weight.b > 0.0f ? sum.light.b / sum.weight.b : own_light.b;
#endif
  }
  return times(mean, 1.0f / (float)counts->seeds);
}

// The disc of a pixel where depth has these slopes.
static inline Disc disc_at(const struct FrameParams* f, const Points* p, float slope_x, float slope_y,
                           const RgbRow* normals, int x) {
  const float size_x = fma(p->z, f->slope_x, f->mm_per_px_x);
  const float size_y = fma(p->z, f->slope_y, f->mm_per_px_y);
#if TANGENT_DISC
  // How depth changes along the screen where the ray goes `forward`.
  float change_x = slope_x / size_x;
  float change_y = slope_y / size_y;
  float forward = 1.0f;
#if HAS_NORMAL
  // Along a plane n.P does not change. Lengths of normals do not matter, so that the largest part is made 1.
  const vrgb n = read_rgb(normals, x);
  const float facing = -fma(n.r, p->x_per_z, fma(n.g, p->y_per_z, n.b));
  const float largest = fmax(fmax(fabs(n.r), fabs(n.g)), facing);
  if (facing > 0.0f && isfinite(n.r) && isfinite(n.g) && isfinite(facing)) {
    change_x = n.r / largest;
    change_y = n.g / largest;
    forward = facing / largest;
  }
#endif
  const float along = sqrt(fma(change_x, change_x, change_y * change_y));
  const float limit = STEEPEST / fmax(along, STEEPEST * forward);
  return disc_of(tangent_x(f, p, limit * change_x * size_x), tangent_y(f, p, limit * change_y * size_y));
#else
  const Vectors across = {size_x, 0.0f, 0.0f};
  const Vectors down = {0.0f, size_y, 0.0f};
  return disc_of(across, down);
#endif
}

// The share of all samples in the result of a pixel; the others are few.
static inline float share_of_all(const struct FrameParams* f, const Pixel* pixel, float radius_mm,
                                 const struct DiscCounts* counts) {
  if (counts->samples[0] == 0) return 1.0f;
  const float finest_mm =
      fmin(fma(pixel->p.z, f->slope_x, f->mm_per_px_x), fma(pixel->p.z, f->slope_y, f->mm_per_px_y));
  const float radius_px = radius_mm * pixel->width / finest_mm;
  return clamp((radius_px - FEW_RADIUS_PX) / (ALL_RADIUS_PX - FEW_RADIUS_PX), 0.0f, 1.0f);
}

// A work-item has a run of `columns` pixels of a row.
kernel void disc(struct FrameParams f, struct FrameLayouts layouts, global const uchar* normal,
                 global const struct MaterialParams* materials, global const struct ProfileParams* profiles,
                 global const float4* nodes, global const struct DiscParams* discs,
                 global const struct SampleParams* samples, struct DiscCounts counts, global const float2* turns,
                 struct WindowParams window, global uchar* memory, struct TexelLevels levels,
                 global const struct TexelParams* texels, global const uchar* lit, int first_row, int columns,
                 global float* deferred, global volatile int* counters) {
  const Window w = window_in(&window, memory);
  const int y = first_row + get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  global const uchar* dark = lit + f.blocks_x * f.blocks_y + y / BLOCK * f.blocks_x;
  const RgbRow normals = rgb_row_of(normal, &layouts.normal, f.width, y);
  int unlit = 0;
  for (int x = x_begin; x < min(x_begin + columns, f.width); ++x) {
    const size_t at = pixel_at(&w, x, y);
    const int m = w.material[at];
    const vrgb own_light = load_rgb(w.light, w.plane, at);
    vrgb result = own_light;
    if (m != 0 && (m & NARROW_BIT) == 0) {
      if (dark[x / BLOCK]) {
        ++unlit;
      } else {
        global const struct TexelParams* texel = texels + (size_t)y * f.width + x;
        Pixel pixel = {.f = &f, .levels = &levels, .texels = texels, .x = x, .y = y, .material = m};
        pixel.p = points_at(&f, w.depth[at], x, y);
        pixel.profile = profile_of(profiles + m - 1, nodes, width_reciprocal(&w, at));
#if PIXEL_WIDTH
        pixel.width = widest_factor(materials + m - 1, load_rgb(w.width, w.plane, at));
#else
        pixel.width = 1.0f;
#endif
        pixel.disc = disc_at(&f, &pixel.p, texel->slope_x, texel->slope_y, &normals, x);
        pixel.own = own_share(&f, &pixel.p, &pixel.profile, texel->slope_x, texel->slope_y, texel->area);
        pixel.own_light = own_light;
        const float share = share_of_all(&f, &pixel, materials[m - 1].radius_mm, &counts);
        result = broadcast_rgb(0.0f);
        for (int which = 0; which < 2; ++which) {
          const float part = which == 0 ? 1.0f - share : share;
          if (part == 0.0f) continue;
          const vrgb mean = gather(&pixel, discs + m - 1, samples, &counts, which, turns);
          result = sum_rgb(result, times(mean, part));
        }
      }
    }
    store_deferred(&f, deferred, x, y, result);
  }
  if (unlit > 0) atomic_add(counters + COUNTER_UNLIT, unlit);
}
