// How Cycles samples a profile: a distance is drawn on a plane across the normal (half of the time) or along it, and
// projected to the surface. All three could have found a point, and are weighed by the power heuristic, but the change
// of area is left out: R(r) is multiplied by r sum_a w_a / r_a, with the distance r_a as axis a sees it.
#include "frame/surface.h"

// A normal and two unit vectors at right angles to it and to each other.
typedef struct {
  Vectors axis[3];
} Axes;

static inline vfloat product_of(const Vectors* a, const Vectors* b) { return a->x * b->x + a->y * b->y + a->z * b->z; }

static inline Vectors unit_vectors(Vectors a) {
  const vfloat shorter = 1.0f / sqrt(product_of(&a, &a));
  const Vectors unit = {a.x * shorter, a.y * shorter, a.z * shorter};
  return unit;
}

static inline Axes axes_about(Vectors n) {
  const vint is_diagonal = AS_MASK(n.x == n.y) & AS_MASK(n.x == n.z);
  const Vectors across = {n.z - n.y, select(n.x - n.z, n.x + n.z, is_diagonal),
                          select(n.y - n.x, -n.y - n.x, is_diagonal)};
  Axes axes = {{n, unit_vectors(across), n}};
  axes.axis[2] = cross_product(&n, &axes.axis[1]);
  return axes;
}

// For a patch of that area, which no axis sees as a point.
static inline vfloat projection_factor(const Axes* axes, Vectors normal, Vectors way, vfloat area_mm2) {
  const vfloat size = 0.05f * area_mm2;
  vfloat sum = (vfloat)(0.0f);
  vfloat all = (vfloat)(1e-12f);
  for (int a = 0; a < 3; ++a) {
    const vfloat chance = (a == 0 ? 0.5f : 0.25f) * fabs(product_of(&axes->axis[a], &normal));
    // Not r^2 less the square along the axis, which may be nearly all of it.
    const vfloat seen = squared_length(cross_product(&axes->axis[a], &way)) + size;
    sum += chance * chance / sqrt(seen);
    all += chance * chance;
  }
  return sqrt(squared_length(way) + size) * sum / all;
}
