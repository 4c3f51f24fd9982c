// Textures: the caller's images, texels and blocks.
#include "frame/image.h"
#include "frame/light.h"

// The images that are read.
typedef struct {
  global const uchar *light, *albedo, *mask, *stretch_u, *stretch_v;
  struct TextureLayouts at;
} TextureImages;

// V texels as they are read.
typedef struct {
  vrgb light, albedo;
  vfloat stretch_u, stretch_v;  // mm
  vint object;                  // mask of the lanes that are not empty
} Texels;

static inline vint finite_rgb(vrgb v) {
  const vfloat sum = (v.r - v.r) + (v.g - v.g) + (v.b - v.b);
  return AS_MASK(sum == 0.0f);
}

static inline vint valid_stretch(vfloat mm) { return AS_MASK(mm >= 1e-9f) & AS_MASK(mm <= 1e9f); }

// V texels from x on; their light is times albedo^m, and 0 in empty lanes.
SHARED Texels read_texels(const struct TextureParams* t, const TextureImages* in, int x, int y) {
  const RgbRow light_row = rgb_row_of(in->light, &in->at.light, t->width, y);
  Texels texels;
  texels.light = read_rgb(&light_row, x);
  texels.object = AS_MASK(x + int_lane_numbers() < (vint)(t->width));
#if HAS_ALBEDO
  const RgbRow albedo_row = rgb_row_of(in->albedo, &in->at.albedo, t->width, y);
  texels.albedo = read_rgb(&albedo_row, x);
  texels.object &= finite_rgb(texels.light) & finite_rgb(texels.albedo);
  if (t->albedo_mix != 0.0f) texels.light = product(texels.light, albedo_power(texels.albedo, t->albedo_mix));
#else
  texels.albedo = broadcast_rgb((vfloat)(1.0f));
#endif
  texels.object &= finite_rgb(texels.light);
#if HAS_MASK
  texels.object &= AS_MASK(read_values(row_of(in->mask, &in->at.mask, t->width, y, 0), x) > 0.0f);
#endif
#if HAS_STRETCH
  texels.stretch_u = read_values(row_of(in->stretch_u, &in->at.stretch_u, t->width, y, 0), x);
  texels.stretch_v = read_values(row_of(in->stretch_v, &in->at.stretch_v, t->width, y, 0), x);
  texels.object &= valid_stretch(texels.stretch_u) & valid_stretch(texels.stretch_v);
#else
  texels.stretch_u = texels.stretch_v = (vfloat)(t->mm_per_texel);
#endif
  texels.light = select_or_zero_rgb(texels.object, texels.light);
  return texels;
}

// Texels of a plane.
static inline size_t plane_of(const struct TextureParams* t) { return (size_t)t->stride * t->height; }

static inline size_t texel_at(const struct TextureParams* t, int x, int y) { return (size_t)y * t->stride + x; }

// The block of a work-group, whose items take V of its columns in turn: on CPUs one item takes all.
typedef struct {
  int index;
  int x, y;                            // of the block among blocks
  int x_begin, x_end, y_begin, y_end;  // texels; x_begin is the item's first one
  int x_step;
  int size;  // texels of the whole block
} Block;

static inline Block its_block(const struct TextureParams* t) {
  const int block_x = get_group_id(0);
  const int block_y = get_group_id(1);
  const int x = block_x * BLOCK_WIDTH;
  const int y = block_y * BLOCK_HEIGHT;
  const int x_end = min(x + BLOCK_WIDTH, t->width);
  const int y_end = min(y + BLOCK_HEIGHT, t->height);
  const int own = get_local_id(0) * V;
  const Block block = {
      block_y * t->blocks_x + block_x, block_x, block_y, x + own, x_end, y, y_end, get_local_size(0) * V,
      (x_end - x) * (y_end - y)};
  return block;
}

// Whether a work-item speaks for its group.
static inline int is_first_item(void) { return get_local_id(0) == 0; }

static inline int blocks_of(const struct TextureParams* t) { return t->blocks_x * t->blocks_y; }
