// What the host tells the kernels. Compiles as C++ and as OpenCL C.
#ifndef DERMIS_PARAMS_H
#define DERMIS_PARAMS_H

#ifdef __OPENCL_VERSION__
typedef long Bytes;
#else
typedef long long Bytes;
#endif

// Pixels of a row that share their tap positions; they start at multiples of this. It is part of the method, not of a
// device: the result does not depend on the vector width.
#define SPAN 16

// Elements before the first and after the last pixel of a working row, so that a vector that straddles the frame's edge
// stays in memory.
#define PADDING 16

// A byte of the material plane: 0 = no material, else 1 + the index of the material. A pixel whose kernel is narrower
// than half a pixel gives light but takes none.
#define MATERIAL_MASK 0x7f
#define NARROW_BIT 0x80
#define MAX_MATERIALS 127

// What a tile needs.
#define TILE_EMPTY 0
#define TILE_NARROW 1
#define TILE_SCATTERS 2

// Counters of a tile.
#define COUNT_SCATTERED 0
#define COUNT_NARROW 1
#define COUNT_WITHOUT_MATERIAL 2
#define COUNT_BAD 3
#define COUNTERS 4

// Directions of the rotation of tap axes.
#define ROTATIONS 256

// Format of a value, as dermis::Format.
#define FORMAT_F16 0
#define FORMAT_F32 1
#define FORMAT_U8 2
#define FORMAT_U16 3
#define FORMAT_U32 4

// Where the values of a caller's image lie, in bytes.
struct ImageParams {
  Bytes offset;
  Bytes row_stride;
  int pixel_stride;
  int channel_stride;
  int format;
  int padding;
};

// One frame. A pixel at view depth z spans mm_per_px + slope * z, in x and in y.
struct FrameParams {
  int width;
  int height;
  int stride;  // of the working planes, in elements
  int spans;   // per row
  int tile_width;
  int tile_height;
  float mm_per_unit;
  float mm_per_px_x;
  float mm_per_px_y;
  float slope_x;  // mm per px per mm of depth: 0 if orthographic
  float slope_y;
  float center_x;
  float center_y;
  float albedo_mix;
};

// Where one RadialTable lies in the buffer of tables.
struct TableParams {
  int first;       // index of the first node
  int first_bits;  // float bits of r^2 there
  int last_bits;   // bits of the last node less first_bits
};

// One material. The exact integral has one term.
struct MaterialParams {
  float radius_mm;  // of the separable passes
  float reach_mm;   // of the exact integral
  float relative_width[3];
  int width_follows_albedo;
  int id;
  int first_rung;
  int rungs;
  int first_term;
};

// One term: scale f(x) f(y).
struct TermParams {
  float scale[3];
  float sum[3];
  int normalised;
  struct TableParams falloff;  // f(r) for separable passes, R(r) for the exact integral
  struct TableParams core;     // integral of f over |x| < r, or of R over the disc of radius r
};

// One tap set. Its weights are those of the centre, then of each pair; of every term each time.
struct RungParams {
  float footprint;
  float core_half_width_px;
  int first_offset;
  int pairs;
  int rotated_pairs;  // the first ones
  int first_weight;
};

// What a pair of taps is worth in one term; of a centre, length_mm is the gain of the core.
struct WeightParams {
  float length_mm[3];
  float share[3];  // of its weight in the first term
};

// One rotation of the axes, times 4096: the offset (o, 0) of the horizontal pass becomes (o * cosine, o * sine_x), the
// offset (0, o) of the vertical pass (o * sine_y, o * cosine).
struct RotationParams {
  int cosine;
  int sine_x;
  int sine_y;
  int padding;
};

#endif
