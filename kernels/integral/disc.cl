// disc: light from importance-sampled points of a disc about each pixel (Golubev 2018),
//     M(p) = (own E(p) + sum a_i J_i R(|P_p - P_i|) E_i) / (own + sum a_i J_i R(|P_p - P_i|)),
// where sample i stands for the area a_i of the disc, J_i is how much more surface than disc there is under it, and own
// is the light that stays on the pixel, where no sample reads.
#pragma OPENCL FP_CONTRACT OFF
#include "base/linear_table.h"
#include "base/rotation.h"
#include "frame/load.h"
#include "integral/own_share.h"

#if V != 1
#error "V: samples of a pixel lie anywhere, so that it is alone"
#endif

// The kernel radius, px, up to which there are few samples, and from which on there are all. Between them there are
// both.
#define FEW_RADIUS_PX 2.0f
#define ALL_RADIUS_PX 3.0f

// A disc is tilted no more than this, as change of depth per change of place on the screen: samples of one that is seen
// edge on would lie on a line, whatever the surface does beside it.
#define STEEPEST 0.75f

// No sample is farther, px.
#define FARTHEST_PX 131072.0f

// How a plane is seen about a pixel. Its axes are mm along the plane, at right angles.
typedef struct {
  float x_x, x_y, y_x, y_y;  // px along x for each mm along either axis, and along y
  float px_per_mm;           // the root of the determinant
  float inner_mm;            // the disc that the pixel contains
} Disc;

// Of the plane in which a pixel spans these (Gram and Schmidt).
static inline Disc disc_of(Tangent x, Tangent y) {
  const float length_x = sqrt(squared_length(x));
  const float along = fma(x.x, y.x, fma(x.y, y.y, x.z * y.z)) / length_x;
  const float area = patch_area(x, y);
  const float across = area / length_x;
  const float length_y = sqrt(squared_length(y));
  const Disc disc = {1.0f / length_x, -along / area,     0.0f,
                     1.0f / across,   1.0f / sqrt(area), 0.5f * area / fmax(length_x, length_y)};
  return disc;
}

// The same with the axes turned.
static inline Disc turned(Disc d, float2 turn) {
  const Disc result = {fma(d.x_x, turn.x, d.x_y * turn.y),
                       fma(d.x_y, turn.x, -d.x_x * turn.y),
                       fma(d.y_x, turn.x, d.y_y * turn.y),
                       fma(d.y_y, turn.x, -d.y_x * turn.y),
                       d.px_per_mm,
                       d.inner_mm};
  return result;
}

// A pixel that takes light, and what its samples read.
typedef struct {
  const struct FrameParams* f;
  const struct TexelLevels* levels;
  global const struct TexelParams* texels;
  int x, y;
  int material;  // 1 + index
  Points p;
} Pixel;

// What lies under a sample: sums over the texels that it touches, by its share on each.
typedef struct {
  vrgb light;  // times area
  float area;  // per px, times share
  float rise;  // depth less that of the pixel, times share
  float share;
} Reading;

// Reads blocks of 2^level pixels a side, (x, y) pixels away: the four about that point, by the share of a square of
// side 1 / `sharpness` blocks that lies on each side of the lines between them. The pixel itself has no share. Returns
// 0 if one of them, of blocks larger than a pixel, is not all of the material or holds the pixel itself.
SHARED int read_level(Reading* reading, const Pixel* pixel, int level, float sharpness, float x, float y) {
  const float size_px = (float)(1 << level);
  const float to_blocks = 1.0f / size_px;
  const int width = pixel->f->width >> level;
  const int height = pixel->f->height >> level;
  const int own_x = pixel->x >> level;
  const int own_y = pixel->y >> level;
  // Of the block that holds the pixel.
  const float middle_x = ((float)(own_x << level) + 0.5f * size_px) - ((float)pixel->x + 0.5f);
  const float middle_y = ((float)(own_y << level) + 0.5f * size_px) - ((float)pixel->y + 0.5f);
  const float u = (x - middle_x) * to_blocks;
  const float v = (y - middle_y) * to_blocks;
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

// The level whose blocks are as large as what a sample stands for, or just below.
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

// The samples of a set, for a profile `width` times as wide.
static inline void add_samples(Sum* sum, const Pixel* pixel, global const struct SampleParams* samples, int count,
                               Disc d, float width, global const float4* tables, struct TableParams radial,
                               vrgb reciprocal) {
  const vrgb per_area = product(reciprocal, reciprocal);
  for (int i = 0; i < count; ++i) {
    const struct SampleParams sample = samples[i];
    const float a = width * sample.x_mm;
    const float b = width * sample.y_mm;
    const float x = clamp(fma(d.x_x, a, d.x_y * b), -FARTHEST_PX, FARTHEST_PX);
    const float y = clamp(fma(d.y_x, a, d.y_y * b), -FARTHEST_PX, FARTHEST_PX);
    const float spacing_px = width * sample.spacing_mm * d.px_per_mm;
    const Reading reading = read_at(pixel, spacing_px, x, y);
    if (reading.share == 0.0f) continue;
    const float r_squared = squared_distance_to(pixel->f, &pixel->p, x, y, reading.rise / reading.share);
    const vrgb density = product(look_up_linear_scaled(tables, radial, r_squared, reciprocal), per_area);
    const vrgb weight = times(density, spacing_px * spacing_px);
    sum->weight = sum_rgb(sum->weight, times(weight, reading.area));
    sum->light = multiply_add(weight, reading.light, sum->light);
  }
}

// The mean over all seeds.
static inline vrgb gather(const Pixel* pixel, global const struct DiscParams* its, int which,
                          global const struct SampleParams* samples, const struct DiscCounts* counts,
                          global const float2* turns, Disc d, float width, global const float4* tables,
                          struct TableParams radial, vrgb reciprocal, vrgb own, vrgb own_light) {
  int start = 0;
  while (start + 1 < DISC_STARTS && d.inner_mm >= width * its->inner_mm[which][start + 1]) ++start;
  const int count = counts->samples[which];
  global const struct SampleParams* set = samples + its->first_sample[which] + start * count;
  vrgb mean = broadcast_rgb(0.0f);
  for (int i = 0; i < counts->seeds; ++i) {
    const float2 turn = turns[rotation_index(pixel->x, pixel->y, counts->seed + i)];
    Sum sum = {product(own, own_light), own};
    add_samples(&sum, pixel, set, count, turned(d, turn), width, tables, radial, reciprocal);
    mean.r += sum.weight.r > 0.0f ? sum.light.r / sum.weight.r : own_light.r;
    mean.g += sum.weight.g > 0.0f ? sum.light.g / sum.weight.g : own_light.g;
    mean.b += sum.weight.b > 0.0f ? sum.light.b / sum.weight.b : own_light.b;
  }
  return times(mean, 1.0f / (float)counts->seeds);
}

// The disc of a pixel, where depth has these slopes.
static inline Disc disc_at(const struct FrameParams* f, const Points* p, float slope_x, float slope_y,
                           const RgbRow* normals, int x) {
  const float size_x = fma(p->z, f->slope_x, f->mm_per_px_x);
  const float size_y = fma(p->z, f->slope_y, f->mm_per_px_y);
#if TANGENT_DISC
  // As change of depth per change of place on the screen.
  float steep_x = slope_x / size_x;
  float steep_y = slope_y / size_y;
#if HAS_NORMAL
  // Along a plane n.P does not change.
  const vrgb n = read_rgb(normals, x);
  const float facing = -fma(n.r, p->x_per_z, fma(n.g, p->y_per_z, n.b));
  const float its_steep_x = n.r / facing;
  const float its_steep_y = n.g / facing;
  if (facing > 0.0f && isfinite(its_steep_x) && isfinite(its_steep_y)) {
    steep_x = its_steep_x;
    steep_y = its_steep_y;
  }
#endif
  const float steep = sqrt(fma(steep_x, steep_x, steep_y * steep_y));
  const float deferred = steep > STEEPEST ? STEEPEST / steep : 1.0f;
  return disc_of(tangent_x(f, p, deferred * steep_x * size_x), tangent_y(f, p, deferred * steep_y * size_y));
#else
  const Tangent across = {size_x, 0.0f, 0.0f};
  const Tangent down = {0.0f, size_y, 0.0f};
  return disc_of(across, down);
#endif
}

// A work-item has a run of `columns` pixels of a row.
kernel void disc(struct FrameParams f, struct WindowParams window, int first_row,
                 global const struct MaterialParams* materials, global const float4* tables,
                 global const struct DiscParams* discs, global const struct SampleParams* samples,
                 struct DiscCounts counts, global const float2* turns, global uchar* memory, long plane,
                 struct TexelLevels levels, global const struct TexelParams* texels, global const uchar* lit,
                 global const uchar* normal, struct ImageParams normal_at, int columns, global float* deferred,
                 global volatile int* counters) {
  const Window w = window_in(window, plane, 1, memory);
  const int y = first_row + get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  global const uchar* dark = lit + f.blocks_x * f.blocks_y + y / BLOCK * f.blocks_x;
  const RgbRow normals = rgb_row_of(normal, &normal_at, f.width, y);
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
        global const struct MaterialParams* its = materials + m - 1;
        global const struct TexelParams* texel = texels + (size_t)y * f.width + x;
        const Pixel pixel = {&f, &levels, texels, x, y, m, points_at(&f, w.depth[at], x, y)};
        const vrgb reciprocal = width_reciprocal(&w, at);
#if PIXEL_WIDTH
        const float width = widest_factor(its, load_rgb(w.width, w.plane, at));
#else
        const float width = 1.0f;
#endif
        const vrgb own =
            own_share(&f, &pixel.p, tables, its->cumulated, reciprocal, texel->slope_x, texel->slope_y, texel->area);
        const Disc d = disc_at(&f, &pixel.p, texel->slope_x, texel->slope_y, &normals, x);
        const float finest_mm =
            fmin(fma(pixel.p.z, f.slope_x, f.mm_per_px_x), fma(pixel.p.z, f.slope_y, f.mm_per_px_y));
        const float share =
            counts.samples[0] == 0
                ? 1.0f
                : clamp((its->radius_mm * width / finest_mm - FEW_RADIUS_PX) / (ALL_RADIUS_PX - FEW_RADIUS_PX), 0.0f,
                        1.0f);
        result = broadcast_rgb(0.0f);
        for (int which = 0; which < 2; ++which) {
          const float part = which == 0 ? 1.0f - share : share;
          if (part == 0.0f) continue;
          const vrgb mean = gather(&pixel, discs + m - 1, which, samples, &counts, turns, d, width, tables, its->radial,
                                   reciprocal, own, own_light);
          result = sum_rgb(result, times(mean, part));
        }
      }
    }
    store_rgb(deferred, (size_t)f.stride * f.height, surface_at(&f, x, y), result);
  }
  if (unlit > 0) atomic_add(counters + COUNTER_UNLIT, unlit);
}
