// view_pixels: finds where the surface of each pixel of a view lies, how much of it there is, and whether the camera of
// the frame sees it. A work-item has a row of pixels, or one pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "frame/load.h"
#include "frame/material.h"

// How far from a plane a point may lie to be on it, in sizes of a pixel of the frame.
#define ON_PLANE_PX 1.5f
// How far in front of what the camera sees a point lies that cannot be there.
#define IN_FRONT_PX 4.0f

typedef struct {
  float x, y, z;
} Vector;

static inline float dot_of(Vector a, Vector b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

static inline Vector minus(Vector a, Vector b) {
  const Vector v = {a.x - b.x, a.y - b.y, a.z - b.z};
  return v;
}

static inline Vector times_vector(float a, Vector b) {
  const Vector v = {a * b.x, a * b.y, a * b.z};
  return v;
}

static inline int is_finite_vector(Vector v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static inline void store_vector(global float* to, Vector v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

typedef struct {
  const struct ViewParams* params;
  const struct ViewLayouts* layouts;
  global const uchar *light, *albedo, *position, *normal, *material;
} View;

static inline Vector read_vector(global const uchar* image, const struct ImageParams* p, int x, int y) {
  const Vector v = {value_at(image + byte_at(p, x, y, 0), p->format), value_at(image + byte_at(p, x, y, 1), p->format),
                    value_at(image + byte_at(p, x, y, 2), p->format)};
  return v;
}

// Turns a vector to the axes of the frame's camera, and scales it to mm.
static inline Vector turned_to_camera(const View* view, Vector v) {
  const float* m = view->params->to_camera;
  const Vector rows[3] = {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}};
  const Vector result = {dot_of(rows[0], v), dot_of(rows[1], v), dot_of(rows[2], v)};
  return result;
}

static inline Vector position_at(const View* view, int x, int y) {
  const float* m = view->params->to_camera;
  const Vector v = turned_to_camera(view, read_vector(view->position, &view->layouts->position, x, y));
  const Vector result = {v.x + m[3], v.y + m[7], v.z + m[11]};
  return result;
}

static inline int material_at(const View* view, global const struct MaterialParams* materials, int x, int y) {
#if HAS_MATERIAL
  const struct ImageParams* p = &view->layouts->material;
  return find_material(value_at(view->material + byte_at(p, x, y, 0), p->format), materials);
#else
  return 1;
#endif
}

// The way along the surface to the next pixel along (dx, dy): the mean of the ways from and to both neighbours of the
// material, but the shorter one alone where the other is more than twice as long, for that leads to another sheet.
static inline Vector way_along(const View* view, global const struct MaterialParams* materials, int material, Vector at,
                               Vector normal, int x, int y, int dx, int dy) {
  Vector ways[2];
  float lengths[2];
  int count = 0;
  for (int side = -1; side <= 1; side += 2) {
    const int u = x + side * dx;
    const int v = y + side * dy;
    if (u < 0 || v < 0 || u >= view->params->width || v >= view->params->height) continue;
    if (material_at(view, materials, u, v) != material) continue;
    const Vector there = position_at(view, u, v);
    const Vector normal_there = turned_to_camera(view, read_vector(view->normal, &view->layouts->normal, u, v));
    if (!is_finite_vector(there) || !is_finite_vector(normal_there)) continue;
    if (!(dot_of(normal_there, normal) > 0.0f)) continue;
    const Vector way = times_vector((float)side, minus(there, at));
    ways[count] = minus(way, times_vector(dot_of(way, normal), normal));
    lengths[count] = sqrt(dot_of(ways[count], ways[count]));
    ++count;
  }
  const Vector none = {0.0f, 0.0f, 0.0f};
  if (count == 0) return none;
  if (count == 1 || 2.0f * lengths[0] < lengths[1]) return ways[0];
  if (2.0f * lengths[1] < lengths[0]) return ways[1];
  const Vector mean = {0.5f * (ways[0].x + ways[1].x), 0.5f * (ways[0].y + ways[1].y), 0.5f * (ways[0].z + ways[1].z)};
  return mean;
}

// The frame whose camera looks.
typedef struct {
  const struct FrameParams* f;
  const struct FrameLayouts* layouts;
  global const uchar* depth;
  global const uchar* material_ids;
} Seen;

// Whether the camera of the frame sees a point: one of the 3 x 3 pixels about it shows the same plane of its material.
static inline int place_of(const Seen* seen, int material, Vector at, Vector normal) {
  const struct FrameParams* f = seen->f;
  const int is_perspective = f->slope_x > 0.0f;
  if (is_perspective && !(at.z > 0.0f)) return PLACE_HIDDEN;
  const float size_x = fma(at.z, f->slope_x, f->mm_per_px_x);
  const float size_y = fma(at.z, f->slope_y, f->mm_per_px_y);
  const float size = fmax(size_x, size_y);
  const float px = floor(at.x / size_x + f->center_x);
  const float py = floor(at.y / size_y + f->center_y);
  if (!(px >= 1.0f && py >= 1.0f && px < (float)(f->width - 1) && py < (float)(f->height - 1))) return PLACE_HIDDEN;
  const Vector ray = {is_perspective ? at.x : 0.0f, is_perspective ? at.y : 0.0f, is_perspective ? at.z : 1.0f};
  const int faces_camera = dot_of(ray, normal) < 0.0f;
  int is_in_front = 1;
  for (int y = (int)py - 1; y <= (int)py + 1; ++y) {
    for (int x = (int)px - 1; x <= (int)px + 1; ++x) {
      const struct ImageParams* p = &seen->layouts->depth;
      const float z = value_at(seen->depth + byte_at(p, x, y, 0), p->format) * f->mm_per_unit;
      is_in_front = is_in_front && !(z <= at.z + IN_FRONT_PX * size);
      const int m = seen->material_ids[plane_index(f, x, y)] & MATERIAL_MASK;
      if (!faces_camera || m != material) continue;
      const Vector there = {((float)x + 0.5f - f->center_x) * fma(z, f->slope_x, f->mm_per_px_x),
                            ((float)y + 0.5f - f->center_y) * fma(z, f->slope_y, f->mm_per_px_y), z};
      if (fabs(dot_of(minus(there, at), normal)) < ON_PLANE_PX * size) return PLACE_SEEN;
    }
  }
  return is_in_front ? PLACE_CONTRADICTING : PLACE_HIDDEN;
}

kernel void view_pixels(struct FrameParams f, struct FrameLayouts layouts, global const uchar* depth,
                        global const uchar* material_ids, struct ViewParams params, struct ViewLayouts view_layouts,
                        global const uchar* light, global const uchar* albedo, global const uchar* position,
                        global const uchar* normal, global const uchar* material,
                        global const struct MaterialParams* materials, int columns, global struct ViewPixel* pixels) {
  const View view = {&params, &view_layouts, light, albedo, position, normal, material};
  const Seen seen = {&f, &layouts, depth, material_ids};
  const int y = get_global_id(1);
  const int x_begin = (int)get_global_id(0) * columns;
  const RgbRow lights = rgb_row_of(light, &view_layouts.light, params.width, y);
#if HAS_ALBEDO
  const RgbRow albedos = rgb_row_of(albedo, &view_layouts.albedo, params.width, y);
#endif
  for (int x = x_begin; x < min(x_begin + columns, params.width); ++x) {
    global struct ViewPixel* pixel = pixels + (size_t)y * params.width + x;
    vrgb its_albedo = broadcast_rgb(1.0f);
#if HAS_ALBEDO
    its_albedo = read_rgb(&albedos, x);
#endif
    const vrgb written_light = read_rgb(&lights, x);
    const vrgb its_light = scattering_light(&f, written_light, its_albedo);
    const Vector at = position_at(&view, x, y);
    Vector its_normal = turned_to_camera(&view, read_vector(normal, &view_layouts.normal, x, y));
    its_normal = times_vector(1.0f / sqrt(dot_of(its_normal, its_normal)), its_normal);
    int its_material = material_at(&view, materials, x, y);
    if (!is_finite_vector(at) || !is_finite_vector(its_normal)) its_material = 0;
    if (bad_lanes(its_material, written_light, its_albedo, its_light)) its_material = 0;
    pixel->material = its_material;
    if (its_material == 0) continue;
    store_vector(pixel->position, at);
    store_vector(pixel->normal, its_normal);
    store_vector(pixel->along_x, way_along(&view, materials, its_material, at, its_normal, x, y, 1, 0));
    store_vector(pixel->along_y, way_along(&view, materials, its_material, at, its_normal, x, y, 0, 1));
    pixel->light[0] = its_light.r;
    pixel->light[1] = its_light.g;
    pixel->light[2] = its_light.b;
    pixel->place = place_of(&seen, its_material, at, its_normal);
  }
}
