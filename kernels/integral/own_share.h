// The profile of a pixel, and the share of its light that stays on its own patch of surface.
#include "base/linear_table.h"
#include "frame/load.h"
#include "frame/tangent.h"

typedef struct {
  global const float4* nodes;  // of the tables of all materials
  struct TableParams radial, cumulated;
  float reach_mm;
  vrgb reciprocal;  // of the factor by which each channel is wider
} Profile;

static inline Profile profile_of(global const struct ProfileParams* its, global const float4* nodes, vrgb reciprocal) {
  const Profile profile = {nodes, its->radial, its->cumulated, its->reach_mm, reciprocal};
  return profile;
}

// R at a squared distance, mm^2, of a profile that is not wider: R of the wider one is reciprocal^2 times as much.
static inline vrgb radial_at(const Profile* profile, vfloat r_squared) {
  return look_up_linear_scaled(profile->nodes, profile->radial, r_squared, profile->reciprocal);
}

// Gauss-Legendre points and weights on [-1/2, 1/2].
constant float points_8[8] = {-0.480144928f, -0.398333239f, -0.262766205f, -0.0917173212f,
                              0.0917173212f, 0.262766205f,  0.398333239f,  0.480144928f};
constant float weights_8[8] = {0.0506142681f, 0.111190517f, 0.156853323f, 0.181341892f,
                               0.181341892f,  0.156853323f, 0.111190517f, 0.0506142681f};

static inline void add(vrgb* sum, vrgb value) {
  sum->r += value.r;
  sum->g += value.g;
  sum->b += value.b;
}

// The integral of the cumulated profile at the patch's edge over the angle.
static inline vrgb own_share(const struct FrameParams* f, const Points* p, const Profile* profile, vfloat slope_x,
                             vfloat slope_y, vfloat area) {
  const Vectors a = tangent_x(f, p, slope_x);
  const Vectors b = tangent_y(f, p, slope_y);
  vrgb share = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
  for (int i = 0; i < 16; ++i) {
    // Two of the four edges; the other two are their mirror images.
    const float s = i < 8 ? 0.5f : points_8[i - 8];
    const float t = i < 8 ? points_8[i] : 0.5f;
    const Vectors edge = {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
    const vfloat r_squared = squared_length(edge);
    const vfloat angle = weights_8[i & 7] * 0.5f * area / r_squared;
    const vrgb within = look_up_linear_scaled(profile->nodes, profile->cumulated, r_squared, profile->reciprocal);
    add(&share, times(within, angle * M_1_PI_F));
  }
  return share;
}
