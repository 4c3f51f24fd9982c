// view_pixels and view_surface: where the surface of each pixel of a view lies and what light it has, then how much of
// it there is and whether the camera of the frame sees it. A work-item has a run of `columns` pixels of a row.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/load.h"
#include "frame/material.h"
#include "frame/space.h"

// How far from a plane a point may lie to be on it, in sizes of a pixel of the frame.
#define ON_PLANE_PX 1.5f
// How far in front of what the camera sees a point lies that cannot be there.
#define IN_FRONT_PX 4.0f

static inline void store_vector(global float* to, float3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

// Turns a vector to the axes of the frame's camera, and scales it to mm.
static inline float3 turned_to_camera(const float* m, float3 v) {
  return (float3)(dot_of((float3)(m[0], m[1], m[2]), v), dot_of((float3)(m[4], m[5], m[6]), v),
                  dot_of((float3)(m[8], m[9], m[10]), v));
}

// The way along the surface to the next pixel along (dx, dy): the mean of the ways from and to both neighbours of the
// material, but the shorter one alone where the other is more than twice as long, for that leads to another sheet.
static inline float3 way_along(global const struct ViewPixel* pixels, const struct ViewParams* params, int x, int y,
                               int dx, int dy) {
  global const struct ViewPixel* pixel = pixels + (size_t)y * params->width + x;
  const float3 normal = vector_at(pixel->normal);
  float3 ways[2];
  float lengths[2];
  int count = 0;
  for (int side = -1; side <= 1; side += 2) {
    const int u = x + side * dx;
    const int v = y + side * dy;
    if (u < 0 || v < 0 || u >= params->width || v >= params->height) continue;
    global const struct ViewPixel* other = pixels + (size_t)v * params->width + u;
    if (other->material != pixel->material || !(dot_of(vector_at(other->normal), normal) > 0.0f)) continue;
    const float3 way = (float)side * (vector_at(other->position) - vector_at(pixel->position));
    ways[count] = way - dot_of(way, normal) * normal;
    lengths[count] = sqrt(dot_of(ways[count], ways[count]));
    ++count;
  }
  if (count == 0) return (float3)(0.0f);
  if (count == 1 || 2.0f * lengths[0] < lengths[1]) return ways[0];
  if (2.0f * lengths[1] < lengths[0]) return ways[1];
  return 0.5f * (ways[0] + ways[1]);
}

// The frame whose camera looks.
typedef struct {
  const struct FrameParams* f;
  const struct FrameLayouts* layouts;
  global const uchar* depth;
  global const uchar* material_ids;
} Seen;

// Whether the camera of the frame sees a point: one of the 3 x 3 pixels about it shows the same plane of its material.
static inline int place_of(const Seen* seen, int material, float3 at, float3 normal) {
  const struct FrameParams* f = seen->f;
  const int is_perspective = f->slope_x > 0.0f;
  if (is_perspective && !(at.z > 0.0f)) return PLACE_HIDDEN;
  const float size_x = fma(at.z, f->slope_x, f->mm_per_px_x);
  const float size_y = fma(at.z, f->slope_y, f->mm_per_px_y);
  const float size = fmax(size_x, size_y);
  const float px = floor(at.x / size_x + f->center_x);
  const float py = floor(at.y / size_y + f->center_y);
  if (!(px >= 1.0f && py >= 1.0f && px < (float)(f->width - 1) && py < (float)(f->height - 1))) return PLACE_HIDDEN;
  const float3 ray = is_perspective ? at : (float3)(0.0f, 0.0f, 1.0f);
  const int faces_camera = dot_of(ray, normal) < 0.0f;
  int is_in_front = 1;
  for (int y = (int)py - 1; y <= (int)py + 1; ++y) {
    for (int x = (int)px - 1; x <= (int)px + 1; ++x) {
      const float z = read_value(seen->depth, &seen->layouts->depth, f->width, x, y) * f->mm_per_unit;
      is_in_front = is_in_front && !(z <= at.z + IN_FRONT_PX * size);
      const int m = seen->material_ids[plane_index(f, x, y)] & MATERIAL_MASK;
      if (!faces_camera || m != material) continue;
      const float3 there = (float3)(((float)x + 0.5f - f->center_x) * fma(z, f->slope_x, f->mm_per_px_x),
                                    ((float)y + 0.5f - f->center_y) * fma(z, f->slope_y, f->mm_per_px_y), z);
      if (fabs(dot_of(there - at, normal)) < ON_PLANE_PX * size) return PLACE_SEEN;
    }
  }
  return is_in_front ? PLACE_CONTRADICTING : PLACE_HIDDEN;
}

kernel void view_pixels(struct FrameParams f, struct ViewParams params, struct ViewLayouts layouts,
                        global const uchar* light, global const uchar* albedo, global const uchar* position,
                        global const uchar* normal, global const uchar* material,
                        global const struct MaterialParams* materials, int columns, global struct ViewPixel* pixels) {
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  const RgbRow lights = rgb_row_of(light, &layouts.light, params.width, y);
#if HAS_ALBEDO
  const RgbRow albedos = rgb_row_of(albedo, &layouts.albedo, params.width, y);
#endif
  for (int x = x_begin; x < min(x_begin + columns, params.width); ++x) {
    global struct ViewPixel* pixel = pixels + (size_t)y * params.width + x;
    pixel->material = 0;
    int its_material = 1;
#if HAS_MATERIAL
    its_material = find_material(read_value(material, &layouts.material, params.width, x, y), materials);
#endif
    if (its_material == 0) continue;
    const float* m = params.to_camera;
    const float3 at =
        turned_to_camera(m, read_vector(position, &layouts.position, params.width, x, y)) + (float3)(m[3], m[7], m[11]);
    const float3 its_normal = turned_to_camera(m, read_vector(normal, &layouts.normal, params.width, x, y));
    const float3 its_unit = its_normal / sqrt(dot_of(its_normal, its_normal));
    if (!is_finite_vector(at) || !is_finite_vector(its_unit)) continue;
    vrgb its_albedo = broadcast_rgb(1.0f);
#if HAS_ALBEDO
    its_albedo = read_rgb(&albedos, x);
#endif
    const vrgb written_light = read_rgb(&lights, x);
    const vrgb its_light = scattering_light(&f, written_light, its_albedo);
    pixel->material = its_material;
    pixel->place = bad_lanes(its_material, written_light, its_albedo, its_light) ? PLACE_UNLIT : PLACE_HIDDEN;
    store_vector(pixel->position, at);
    store_vector(pixel->normal, its_unit);
    store_vector(pixel->light, (float3)(its_light.r, its_light.g, its_light.b));
  }
}

kernel void view_surface(struct FrameParams f, struct FrameLayouts layouts, global const uchar* depth,
                         global const uchar* material_ids, struct ViewParams params, int columns,
                         global struct ViewPixel* pixels) {
  const Seen seen = {&f, &layouts, depth, material_ids};
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  for (int x = x_begin; x < min(x_begin + columns, params.width); ++x) {
    global struct ViewPixel* pixel = pixels + (size_t)y * params.width + x;
    if (pixel->material == 0 || pixel->place == PLACE_UNLIT) continue;
    store_vector(pixel->along_x, way_along(pixels, &params, x, y, 1, 0));
    store_vector(pixel->along_y, way_along(pixels, &params, x, y, 0, 1));
    pixel->place = place_of(&seen, pixel->material, vector_at(pixel->position), vector_at(pixel->normal));
  }
}
