// The structs and constants that the host and the kernels share. This file compiles as C++ and as OpenCL C: members of
// 8 bytes come first in each struct, so that both lay it out alike.
#ifndef DERMIS_PARAMS_H
#define DERMIS_PARAMS_H

#ifdef __OPENCL_C_VERSION__
typedef long Bytes;
#else
typedef long long Bytes;
#endif

// Pixels on a side of a block; all of them share their tap positions. It is part of the method, not of a device: the
// result depends neither on the vector width nor on the tiles.
#define BLOCK 16

// Rows that the vertical pass of a tile computes as soon as the horizontal one has made what it reads of them.
#define STRIP_ROWS 32

// Pixels of a row that lie in one aligned run have one shear in the vertical pass over a curved block.
#define SHEAR_RUN 8

// A tap level has weights for flat blocks at so many sizes of a pixel between it and the next level.
#define LEVEL_PARTS 8

// A window has so many pixels to the left and to the right of those that taps may fall on, so that a vector that
// straddles the edge stays in memory.
#define PADDING 16

// A byte of the plane of material ids is 0 where there is no material, else 1 + the index of the material. A pixel
// whose kernel is narrower than half a pixel has NARROW_BIT set: it gives light but takes none.
#define MATERIAL_MASK 0x7f
#define NARROW_BIT 0x80
#define MAX_MATERIALS 127

// Light beyond this counts as not finite: sums of it, with weights above 1 and below 0, stay within a float.
#define LARGEST_LIGHT 1e32f

// A surface lies within these distances, mm: areas, the squares of lengths, stay within a float.
#define NEAREST_MM 1e-15f
#define FURTHEST_MM 1e15f

// Counters of a run.
#define COUNTER_NEXT_TILE 0
#define COUNTER_WORKERS 1
#define COUNTER_BAD 2  // pixels, like those that follow
#define COUNTER_SCATTERED 3
#define COUNTER_NARROW 4
#define COUNTER_FLAT 5
#define COUNTER_CHANNELS 6     // channels of pixels that no tap is read for
#define COUNTER_TILE_HEIGHT 7  // px, as the device chose it
#define COUNTER_UNLIT 8        // pixels
#define COUNTER_REACH 9        // px that taps of the vertical pass go at most
#define COUNTER_REACHED 10     // pixels that hidden light reaches
#define COUNTER_FINEST_X 11    // most pixels per mm, as in BlockParams, as the bits of a float above 0
#define COUNTER_FINEST_Y 12
#define RUN_COUNTERS 13

// Kinds of tile, as dermis::TileKind.
#define TILE_WITHOUT_MATERIAL 0
#define TILE_NARROW 1
#define TILE_UNLIT 2
#define TILE_UNIFORM 3
#define TILE_FLAT 4  // all blocks are flat: no depth terms
#define TILE_CURVED 5
#define TILE_REUSED 6  // nothing within reach has changed since the frame before

// No tap of the vertical pass lies more columns than this from its pixel, on a flat block and on a curved one, unless
// it is rotated. Where a surface bends, its shear tells little of what lies farther away.
#define MOST_FLAT_SIDE 32
#define MOST_CURVED_SIDE 6

// Tap axes and discs are turned by multiples of 2 pi over this.
#define ROTATIONS 256

// The samples of a disc may leave out the share i / DISC_STARTS of the light that is nearest.
#define DISC_STARTS 16

// The samples of a disc may read blocks of 1, 2, 4, ... pixels a side: so many sizes.
#define MOST_TEXEL_LEVELS 9

// The separable passes on GPUs: a work-group of so many work-items computes a line of the horizontal pass, and some
// columns of a strip of rows in the vertical one. They lie in GROUP_BLOCKS blocks at most.
#define GROUP_ITEMS 256
#define LINE_COLUMNS GROUP_ITEMS
#define COLUMN_COLUMNS 8
#define COLUMN_ROWS 128
#define GROUP_BLOCKS 16

// A copy of the taps of a level in local memory begins at a multiple of so many words, whole CubicWeights,
// NearnessParams and FlatWeights, and ends with its TapLevelParams.
#define TAP_WORDS 9
#define LEVEL_WORDS 12

// Formats of a value, as dermis::Format.
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

// Where all images of a frame lie; zeros for one that it does not have.
struct FrameLayouts {
  struct ImageParams light, albedo, depth, material, mask, matte, normal, beauty;
  struct ImageParams scattered, result;
};

// Where the images of a view lie.
struct ViewLayouts {
  struct ImageParams light, albedo, position, normal, material;
};

struct ViewParams {
  int width;
  int height;
  float to_camera[12];  // row by row, to mm in the axes of the frame's camera
};

// A pixel of a view, in mm in the axes of the frame's camera.
struct ViewPixel {
  float position[3];
  float normal[3];   // of unit length
  float along_x[3];  // along the surface to the next pixel; 0 if that is not known
  float along_y[3];
  float light[3];
  int material;  // 1 + its index; 0: background, or a place that is not finite
  int place;
};

// Places of a ViewPixel as the frame's camera has it.
#define PLACE_SEEN 0
#define PLACE_HIDDEN 1
#define PLACE_CONTRADICTING 2  // in front of what the camera sees
#define PLACE_UNLIT 3          // its light is not finite: only its neighbours' surface needs it

// Hidden surface: parts x parts areas side by side, each of which stands for the light that enters there.
struct HiddenSample {
  float position[3];  // mm, of the middle
  float area_mm2;     // of a part
  float light[3];
  float normal[3];
  int parts;
  float radius_mm;             // of a ball around the middle that has all parts within it
  float half_x[3], half_y[3];  // half a part, mm: the middles of parts are apart by twice as much
};

// Hidden surface is there in so many levels of detail, for what is near and for what is far: in parts of pixels, and
// joined in cubes, in small ones and in larger ones.
#define HIDDEN_LEVELS 3

// A cube of space with hidden surface of one material.
struct HiddenCell {
  float low[3], high[3];  // mm: around the samples
  int first[HIDDEN_LEVELS], samples[HIDDEN_LEVELS];
};

// How light goes from where it enters to where it leaves.
#define CROSSING_DISTANCE 0   // the profile tells, by their distance
#define CROSSING_PROJECTED 1  // Profile::is_projected
#define CROSSING_WALK 2       // the profile is that of random walks, and surfaces bend

// Gains of a slab over the profile, at so many thicknesses.
#define SLAB_NODES 32

// At what squared distances the samples of a level count, mm^2: between `from` and `to`, and in part where
// slope * distance + offset is below 1, of `rise` from the finer level and of `fall` to the next one. `to_mm` is the
// root of `to`.
struct HiddenLevel {
  float from_mm2, to_mm2, to_mm;
  float rise_slope, rise_offset;
  float fall_slope, fall_offset;
};

struct HiddenMaterial {
  int first_cell, cells;
  float reach_mm;
  struct HiddenLevel levels[HIDDEN_LEVELS];
  int crossing;
  float slab_nodes_per_mm;  // of walks: of slab_gain, by thickness; the first node is at 0
  float bend_mm[3];         // how much a curvature of 1/mm adds
  float mfp2_mm2[3];        // square of the mean free path
  float slab_gain[SLAB_NODES][4] __attribute__((aligned(16)));  // read as float4, whose last number is not used
};

// How the light that enters a medium of random walks grows with the curvature of its surface. Other media have a mean
// free path of 0.
struct CurvatureParams {
  float mfp_mm[3];
  float steeper[3];    // how much more than in proportion a gain grows at first
  float most_gain[3];  // where all light comes back
};

// The choices of a run; each member is 0 or 1.
struct RunFlags {
  int writes_scattered;
  int writes_result;
  int zeroes_bad;  // outputs of pixels whose light is not finite become 0
  int copies;      // pixels that do not scatter are written, too
  int skips;       // a tile under uniform light is not filtered
  int defers;      // light after scattering is kept until the whole frame has been read
  int reuses;      // tiles that have not changed since the frame before keep its deferred light
};

// The size and the camera of a frame, or of a band of its rows: then rows of kernels count from the first one of the
// band, and light is computed, and pixels are counted, in its own rows. A pixel at view depth z spans
// mm_per_px + slope * z, in x and in y.
struct FrameParams {
  int width;
  int height;
  int stride;  // of planes as large as the frame, elements
  int blocks_x;
  int blocks_y;
  int first_row;  // of the band in the frame: a multiple of BLOCK
  int own_begin, own_end;
  float mm_per_unit;
  float mm_per_px_x;
  float mm_per_px_y;
  float slope_x;  // mm per px per mm of depth: 0 if orthographic
  float slope_y;
  float center_x;
  float center_y;
  float aspect2;  // square of the height of a pixel over its width
  float albedo_mix;
  float widest_turn;  // how far a tap that is turned leaves its axis, px per px of its offset
};

// The tiles of a frame.
struct TileParams {
  int width;
  int height;        // the largest one, unless the device has chosen
  int least_height;  // that the device may choose
  int columns;
  int rows;  // of that height
  int workers;
};

// A block as classification sees it.
struct BlockParams {
  float depth_low, depth_high;      // mm; of all pixels with a material
  float along_x_low, along_x_high;  // change of depth to the next pixel of the same material, mm
  float along_y_low, along_y_high;
  float finest_x, finest_y;    // most pixels per mm at a pixel that scatters, times its width factor
  unsigned int scattering[4];  // a bit for each material that some pixel scatters by
  int material;                // byte of all its pixels in the plane of material ids; 0 if they differ
  int scattered;               // pixels
  int narrow;                  // pixels
};

// One pass in a block.
struct BlockPass {
  float px_per_mm;  // chooses the tap levels; 0 if nothing scatters
  int block_class;
  int shear;     // of flat blocks in the vertical pass, px per row times 4096
  int material;  // 1 + the index of the material if all taps fall on it within the frame, or on a curved block on
                 // nothing else but gaps; else 0
};

// Classes of a block in a pass.
#define CLASS_EMPTY -1  // no pixel has a material
#define CLASS_FLAT 0
#define CLASS_CURVED 1

struct BlockPasses {
  struct BlockPass x, y;
};

// The choice of a kernel and its weights for a block in one pass.
struct ChoiceParams {
  int variant;
  int material;    // index
  int level;       // index
  int weight;      // index of the first flat one
  int shear;       // as in BlockPass
  int padding[3];  // what follows in the memory of a tile has to be aligned
};

// The block is empty, or all taps fall on its material and it is of that class, or taps may fall on anything.
#define VARIANT_EMPTY CLASS_EMPTY
#define VARIANT_FLAT CLASS_FLAT
#define VARIANT_CURVED CLASS_CURVED
#define VARIANT_GENERAL 2

// Where the planes of a window begin, bytes: see window.h. The light comes first.
struct WindowLayout {
  Bytes plane;  // elements of each
  Bytes segment;
  Bytes depth;
  Bytes ray_depth;
  Bytes width;
  Bytes material;
  Bytes material_ids;
  Bytes shear;
};

// A part of a frame in memory: see window.h.
struct WindowParams {
  struct WindowLayout planes;
  int x_begin, x_end;
  int y_begin, y_end;
  int row_mask;
  int row_stride;
};

// The memory of a worker that filters one tile after the other: two windows, and where the other parts begin, bytes.
struct TileMemory {
  struct WindowLayout horizontal;
  struct WindowLayout vertical;
  Bytes vertical_window;
  Bytes strip;
  Bytes choices;
  Bytes row_at;
  Bytes side_at;
  Bytes bytes;  // of one worker
};

// Where a LinearTable lies in the buffer of tables.
struct TableParams {
  int first;       // index of the first node
  int first_bits;  // float bits of r^2 there
  int last_bits;   // bits of the last node less first_bits
};

// The factor by which the albedo A of a pixel scales a profile: a cubic over a quadratic, by rising powers of A.
struct WidthParams {
  int follows_albedo;  // else it is 1
  float numerator[4];
  float denominator[3];
};

// One material.
struct MaterialParams {
  float radius_mm;  // of the taps
  float relative_width[3];
  struct WidthParams width;
  int id;
  int first_level;
  int levels;
  int first_term;
};

// The profile of one material, for the methods that sum over the surface.
struct ProfileParams {
  float reach_mm;                // no light comes from farther away
  struct TableParams radial;     // R(r)
  struct TableParams cumulated;  // the light within r
  int is_projected;              // Profile::is_projected
};

// Where the tables of taps begin in their buffer, bytes.
struct TapTables {
  Bytes terms;
  Bytes offsets;
  Bytes nearness;
  Bytes weights;
  Bytes flat_weights;
};

// One term of a kernel: scale f(x) f(y).
struct TermParams {
  float scale[3];
  float sum[3];
  int normalised;
};

// One tap level. Its weights are those of the centre, then of each pair; of every term each time.
struct TapLevelParams {
  float px_per_mm;
  int first_offset;
  int pairs;
  int channel_pairs[3];  // a channel has weights in so many pairs, the first ones; in none if its spread is below half
                         // a pixel
  int rotated_pairs;     // the first ones
  int first_nearness;
  int first_weight;
  int first_flat_weight;  // of the first part
  int last_offset_px;
  int last_rotated_px;
};

// As dermis::Nearness.
struct NearnessParams {
  float scale;
  float softening;
  float end;
};

// The weight of the centre or a pair in one term, on a curved block: dermis::CubicWeight.
struct CubicWeight {
  float a[3], b[3], c[3];
};

// The weight of the centre or a pair in one term, on a flat block.
struct FlatWeight {
  float rgb[3];
};

// Where the images of Shading lie.
struct ShadingImages {
  struct ImageParams position, normal, albedo;       // read
  struct ImageParams light, seen, specular, beauty;  // written
};

// What shade does to a frame.
struct ShadingParams {
  float viewer[4];  // the eye and 1, or the direction to the viewer, of unit length, and 0
  int width;
  int lights;        // how many
  int writes_light;  // 1 if the frame has the output
  int writes_seen;
  int writes_specular;
  int writes_beauty;
  struct TableParams beckmann;  // of the square of the tangent
  float reflectance;            // F0
  float seen_gain;              // 1 / (1 - rho_mean)
  float offset_texels;          // points look themselves up in maps so far above the surface
  float softness_texels;
};

// Where the images of Translucency lie.
struct TranslucencyImages {
  struct ImageParams light, albedo, position, normal, material, mask, thickness, beauty;  // read
  struct ImageParams lit, result;                                                         // written
};

// What transmit does to a frame.
struct TranslucencyParams {
  int width;
  int lights;      // how many
  int writes_lit;  // 1 if the frame has the output
  int writes_result;
  int copies_light;  // 1 unless the output lies over that input
  int copies_beauty;
  float mm_per_unit;
  float thickness_scale;
  float shrink_units;
  float softness_texels;
};

// One material of the transmitted light.
struct SlabParams {
  int id;
  struct WidthParams width;
  struct TableParams transmittance;  // T(s)
};

// Kinds of light, as dermis::Light::Kind.
#define LIGHT_DIRECTIONAL 0
#define LIGHT_POINT 1
#define LIGHT_SPOT 2

// One light, and its map.
struct LightParams {
  int kind;
  int map_width;  // 0 if there is none
  int map_height;
  int first_texel;     // in the buffer of all maps
  float direction[3];  // unit length
  float position[3];
  float colour[3];
  float attenuation[3];
  float cone[2];    // cosine of the outer angle, and 1 / (cosine of the inner one less that)
  float clip_x[4];  // rows of the view-projection matrix
  float clip_y[4];
  float clip_w[4];
  float axis[4];      // times (x, y, z, 1) is the distance along the view axis of the map
  float depth_of[4];  // the distance of what a texel v shows is (a v + b) / (c v + d)
  float bias;
  float texel;  // larger side of a texel, scene units; of a light with a position, per unit of w
};

// Intervals of the table of what a highlight reflects.
#define RHO_NODES 1024

// One rotation of the axes, times 4096: the offset (o, 0) of the horizontal pass becomes (o * cosine, o * sine_x), the
// offset (0, o) of the vertical pass (o * sine_y, o * cosine).
struct RotationParams {
  int cosine;
  int sine_x;
  int sine_y;
  int padding;
};

// A pixel, or a square of pixels, as samples of a disc read it.
struct TexelParams {
  float light[3];
  float area;              // of surface per pixel, mm^2
  float depth;             // in the middle, mm
  float slope_x, slope_y;  // of depth, mm per px
  int material;            // 1 + its index; 0 where it gives no light, or not all of a square does
};

// Where texels lie: level i has width >> i columns, and height >> i rows.
struct TexelLevels {
  Bytes first[MOST_TEXEL_LEVELS];  // texels
  Bytes texels;                    // of all levels
  int count;
  int padding;
};

// One sample of a disc, in the plane of the disc, for a profile as wide as that of the material.
struct SampleParams {
  float x_mm, y_mm;
  float area_mm2;    // it stands for so much of the disc
  float spacing_mm;  // the root of the area
};

// The samples of a material: few of them for narrow kernels, and all for wide ones; DISC_STARTS sets of each.
struct DiscParams {
  int first_sample[2];
  float reach_mm;                  // no sample reads farther
  float inner_mm[2][DISC_STARTS];  // no sample of the set lies nearer, nor does what it stands for
};

// The number of samples that a pixel reads.
struct DiscCounts {
  int samples[2];  // as in DiscParams; the first is 0 if all pixels have as many
  int seeds;       // the result is the mean over so many
  unsigned int seed;
};

// Texture space: texels of a block, the unit of skipping in blurs. A block is whole vectors wide.
#define BLOCK_WIDTH 64
#define BLOCK_HEIGHT 16

// Lanes of the states of a recursion: 8 times the pole pair, plus 4 times the function, plus the channel.
#define STATES 16

// The fate of the light in a block of texels, by channel.
#define LIT_EMPTY 0  // no texel of an object
#define LIT_DARK 1   // no light
#define LIT_BRIGHT 2

// The planes of the Gaussians, each of which has a part in the buffer of what is lit.
#define PLANE_LIGHT 0
#define PLANE_BETWEEN 1  // after the pass along u
#define PLANE_LAST 2     // the Gaussian before
#define BLUR_PLANES 3

// Counters of a run on a texture.
#define COUNTER_EMPTY_TEXELS 0
#define COUNTER_EMPTY_PARTS 1
#define COUNTER_UNLIT_PARTS 2
#define COUNTER_FINEST 3  // the smallest stretch, as the bits of a float above 0, which order as it does
#define TEXTURE_COUNTERS 4

// Where the images of a texture lie.
struct TextureLayouts {
  struct ImageParams light, albedo, mask, stretch_u, stretch_v;  // read
  struct ImageParams scattered, result;                          // written
};

// One texture.
struct TextureParams {
  int width;
  int height;
  int stride;  // of planes, texels
  int blocks_x;
  int blocks_y;
  float mm_per_texel;
  float albedo_mix;
  int writes_scattered;  // 1 if the frame has the output
  int writes_result;
};

// One pass along u, or along v.
struct TexturePass {
  struct ImageParams stretch;  // along the pass
  int along_v;
  int lines_per_item;  // recursion: rows, or columns, of a work-item
};

// One blur of a channel: see GaussianChain. The last four are the host's where all texels are of one size.
struct BlurParams {
  float total_deviation_mm;  // of the Gaussian
  float variance_mm2;        // of the blur that makes it of the Gaussian before
  float deviation_mm;
  float weight;  // of the Gaussian in the result
  int is_first;
  int from_light;    // 1: the blur reads the light, 0: the Gaussian before
  int step;          // texels between taps
  int taps;          // on each side
  int first_weight;  // index
};

// The pole pairs of one pass: see PolePair and recursion.cl.
struct PoleParams {
  float rate[STATES];
  float other_rate[STATES];
  float turn[STATES];
  float share[STATES];
  float other_share[STATES];
  // Where all texels are of one size: over half a texel, and over a whole one.
  float half_texel[3][STATES];
  float texel[3][STATES];
};

#endif
