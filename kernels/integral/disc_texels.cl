// texels and halve_texels make the pixels, and the squares of pixels, that samples of a disc read; light_blocks and
// dark_blocks find the blocks where there is no light for them to find.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/load.h"
#include "frame/tangent.h"

// A work-item has a run of `columns` pixels of a row.
kernel void texels(struct FrameParams f, struct FrameLayouts layouts, global const uchar* matte,
                   struct WindowParams window, global uchar* memory, global struct TexelParams* texels, int columns) {
  const Window w = window_in(&window, memory);
  const int y = get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, f.width); ++x) {
    const size_t at = pixel_at(&w, x, y);
    const Points p = points_at(&f, w.depth[at], x, y);
    const float slope_x = depth_slope(&f, &w, x, y, 1, 0);
    const float slope_y = depth_slope(&f, &w, x, y, 0, 1);
    float area = patch_area(tangent_x(&f, &p, slope_x), tangent_y(&f, &p, slope_y));
#if HAS_MATTE
    area *= share_of_surface(row_of(matte, &layouts.matte, f.width, y, 0), x);
#endif
    const vrgb light = load_rgb(w.light, w.plane, at);
    const struct TexelParams texel = {{light.r, light.g, light.b},   area, p.z, slope_x, slope_y,
                                      w.material[at] & MATERIAL_MASK};
    texels[(size_t)y * f.width + x] = texel;
  }
}

// A quarter of a square may lie off the plane of the square by this share of its side.
#define MOST_BEND 0.25f

// Makes a square of four texels of the level before. It has a material if all of them have that one, and if they lie
// nearly in a plane.
static inline struct TexelParams square_of(const struct TexelParams* four, int side_px) {
  struct TexelParams square = {{0.0f, 0.0f, 0.0f}, 0.0f, 0.0f, 0.0f, 0.0f, four[0].material};
  for (int i = 0; i < 4; ++i) {
    if (four[i].material != square.material) square.material = 0;
    square.area += four[i].area;
    square.depth += 0.25f * four[i].depth;
    square.slope_x += 0.25f * four[i].slope_x;
    square.slope_y += 0.25f * four[i].slope_y;
  }
  if (square.material == 0 || !(square.area > 0.0f)) {
    square.material = 0;
    return square;
  }
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) square.light[c] += four[i].area / square.area * four[i].light[c];
  }
  square.area *= 0.25f;
  const float quarter_px = 0.25f * side_px;
  const float most = MOST_BEND * side_px * sqrt(square.area);
  for (int i = 0; i < 4; ++i) {
    const float across = (i & 1) != 0 ? quarter_px : -quarter_px;
    const float down = (i & 2) != 0 ? quarter_px : -quarter_px;
    const float plane = fma(across, square.slope_x, fma(down, square.slope_y, square.depth));
    if (!(fabs(four[i].depth - plane) <= most)) square.material = 0;
  }
  return square;
}

// Makes a level of the one before it.
kernel void halve_texels(struct FrameParams f, struct TexelLevels levels, int level, global struct TexelParams* texels,
                         int columns) {
  const int width = f.width >> level;
  const int width_before = f.width >> (level - 1);
  const int y = get_global_id(1);
  const int x_begin = get_global_id(0) * columns;
  global const struct TexelParams* above = texels + levels.first[level - 1] + (size_t)(2 * y) * width_before;
  global struct TexelParams* row = texels + levels.first[level] + (size_t)y * width;
  for (int x = x_begin; x < min(x_begin + columns, width); ++x) {
    const struct TexelParams four[4] = {above[2 * x], above[2 * x + 1], above[width_before + 2 * x],
                                        above[width_before + 2 * x + 1]};
    row[x] = square_of(four, 1 << level);
  }
}

// Finds the blocks of which a pixel gives light. A work-item has a block.
kernel void light_blocks(struct FrameParams f, global const struct TexelParams* texels, global uchar* lit) {
  const int block_x = get_global_id(0);
  const int block_y = get_global_id(1);
  if (block_x >= f.blocks_x) return;
  int any = 0;
  for (int y = block_y * BLOCK; y < min(block_y * BLOCK + BLOCK, f.height); ++y) {
    for (int x = block_x * BLOCK; x < min(block_x * BLOCK + BLOCK, f.width); ++x) {
      global const struct TexelParams* texel = texels + (size_t)y * f.width + x;
      any |= texel->material != 0 && (texel->light[0] != 0.0f || texel->light[1] != 0.0f || texel->light[2] != 0.0f);
    }
  }
  lit[block_y * f.blocks_x + block_x] = any;
}

// The pixels along an axis that a disc of a block may reach: rays that are n pixels from each other are at least n
// times the size of a pixel apart on any surface, over the length of the ray per depth.
static inline int reach_px(float reach_mm, float px_per_mm, float ray_length, int most) {
  return (int)fmin(fma(reach_mm * px_per_mm, ray_length, 2.0f), (float)most);
}

// Finds the blocks that no light reaches, and writes them behind all blocks that light_blocks wrote.
kernel void dark_blocks(struct FrameParams f, global const struct DiscParams* discs,
                        global const struct BlockParams* blocks, global uchar* lit) {
  const int block_x = get_global_id(0);
  const int block_y = get_global_id(1);
  if (block_x >= f.blocks_x) return;
  global const struct BlockParams* block = blocks + block_y * f.blocks_x + block_x;
  float reach_mm = 0.0f;
  for (int m = 0; m < MATERIALS; ++m) {
    if (block->scattering[m / 32] >> (m % 32) & 1) reach_mm = fmax(reach_mm, discs[m].reach_mm);
  }
  const float from_center_x = fmax(fabs(block_x * BLOCK - f.center_x), fabs(block_x * BLOCK + BLOCK - f.center_x));
  const int top = block_y * BLOCK + f.first_row;
  const float from_center_y = fmax(fabs(top - f.center_y), fabs(top + BLOCK - f.center_y));
  const float ray_x = f.slope_x * from_center_x;
  const float ray_y = f.slope_y * from_center_y;
  const float ray_length = sqrt(fma(ray_x, ray_x, fma(ray_y, ray_y, 1.0f)));
  const int x_px = reach_px(reach_mm, block->finest_x, ray_length, f.width);
  const int y_px = reach_px(reach_mm, block->finest_y, ray_length, f.height);
  const int x_end = min(block_x * BLOCK + BLOCK - 1 + x_px, f.width - 1) / BLOCK;
  const int y_end = min(block_y * BLOCK + BLOCK - 1 + y_px, f.height - 1) / BLOCK;
  int any = 0;
  for (int y = max(block_y * BLOCK - y_px, 0) / BLOCK; y <= y_end; ++y) {
    for (int x = max(block_x * BLOCK - x_px, 0) / BLOCK; x <= x_end; ++x) any |= lit[y * f.blocks_x + x];
  }
  lit[f.blocks_x * f.blocks_y + block_y * f.blocks_x + block_x] = !any;
}
