/// A plan does once all that is slow: it builds the kernels for the images that frames have, and places and uploads the
/// taps.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/event.hpp"
#include "dermis/frame.hpp"
#include "dermis/profile.hpp"
#include "dermis/taps.hpp"
#include "dermis/words.hpp"

namespace dermis {

/// A profile and the id that the pixels of its surface carry.
struct Material {
  int id = 0;  ///< 0..65535; ignored if the frame has no material ids
  Profile profile;
  std::optional<TapsDesign> taps = {};  ///< in place of Options::taps
  /// Size of a pixel on the surface, mm, at the median depth of its pixels: what taps with a tolerance are chosen for.
  /// 1e-12..1e12; 0: not known, so that a kernel radius of 64 pixels is assumed.
  double pixel_mm = 0;
  /// The same at the nearest depth: no taps are placed for kernels that are wider there than twice their radius, which
  /// saves time and changes no light. 0: not known.
  double finest_pixel_mm = 0;

  bool operator==(const Material&) const = default;
};

enum class Method {
  separable,  ///< a horizontal, then a vertical pass of taps, for every term of the design
  exact,      ///< the surface integral over all visible pixels of the material; slow
  disc,       ///< samples of that integral on a disc about each pixel, as DiscOptions says
};

template <>
inline constexpr std::array<Named<Method>, 3> word_table<Method> = {
    {{Method::separable, "separable"}, {Method::exact, "exact"}, {Method::disc, "disc"}}};

/// Method::disc samples the surface integral on discs (Golubev 2018). The distances of samples from a pixel are those
/// within which even shares of the widest channel's light leave, their directions turn by the golden angle from each to
/// the next, and by a random angle per pixel. A sample weighs R(distance on the surface) / density, times how much more
/// surface than disc there is under it, over the sum of weights; what lies on other materials is left out. The pixel's
/// own light weighs as the profile integrated over its patch, and the samples share the light beyond.
///
/// A sample reads the four pixels about it, by the shares of a square as large as the part of the disc that it stands
/// for, which the lines between them cut. If that is as large as a pixel, this is bilinear interpolation, which blurs
/// the light by about a pixel; where samples lie closer it comes to the nearest pixel, so that the result of ever more
/// of them is the integral, and where they lie farther apart to the mean of four, which has less noise. Pixels that are
/// not of the material have no share.
struct DiscOptions {
  /// Per pixel: 1..1024; 0: 21 for kernels within 4 x 4 pixels, 55 for those from 6 x 6 on, and both blended between.
  int samples = 0;
  /// The disc lies along the surface, by Frame::normal or the slopes of depth, but tilted no more than 3 in 4 from the
  /// screen; else along the screen.
  bool tangent_plane = true;
  /// Samples that stand for more than a pixel read means over as much: blocks of 2 x 2, 4 x 4, ... pixels, where all of
  /// one are of the material and nearly in a plane.
  bool prefiltered = false;
  int accumulate = 1;  ///< the mean of so many results, of Options::seed and the seeds after it: 1..65536

  bool operator==(const DiscOptions&) const = default;
};

/// The output of a pixel whose light or albedo is not finite. Such a pixel never gives light to another.
enum class BadPixels {
  keep,   ///< the pixel is left as it is
  zero,   ///< the outputs of the pixel are 0
  error,  ///< the run fails and writes nothing; not for enqueue
};

template <>
inline constexpr std::array<Named<BadPixels>, 3> word_table<BadPixels> = {
    {{BadPixels::keep, "keep"}, {BadPixels::zero, "zero"}, {BadPixels::error, "error"}}};

/// What a plan computes. With a quality or a tolerance, of which there is one at most and only with the separable
/// method, every material gets as few taps as that takes: see choose_taps.
struct Options {
  Method method = Method::separable;
  std::optional<Quality> quality = {};
  /// Predicted error to be content with, below 1, as a number; if no taps are that good, the method is exact. 0: none.
  double tolerance = 0;
  /// Of every material that does not have its own. Of these, a quality or a tolerance takes neither rank nor count.
  TapsDesign taps = {.rank = 2};
  DiscOptions disc = {};  ///< of Method::disc, which has no taps
  /// The vertical pass crosses the horizontal one at a right angle on the surface instead of on the screen: see Taps.
  /// About half the error where a surface is tilted both ways, for up to twice the time of the blocks that are; it
  /// counts only if there is depth, no jitter, and no quality or tolerance of 2 % and more.
  bool sheared = true;
  double jitter = 0;       ///< share of the kernel radius within which taps are rotated per pixel, 0..1
  std::uint32_t seed = 0;  ///< of the rotation, of taps or of discs
  Lighting lighting = Lighting::raw;
  double albedo_mix = 0;  ///< m in 0..1: albedo^m is put in before the passes, albedo^(1-m) after
  /// More light leaves a medium where its surface bends outwards, and less where it bends inwards: what scatters is the
  /// light times that gain, by the mean free path of each pixel over its radius of curvature. Counts only for random
  /// walks, whose mean free path is known, in frames with depth and normals. METHODS.md, "Curvature".
  bool curvature = true;
  /// The scattered light of a pixel is the sum of weights times light, and is not divided by that of weights. Under a
  /// light of 1 it is then the share of the profile's weight that lies on what the camera sees: 1 on a plane. Not for
  /// frames with views.
  bool sums_weights = false;
  BadPixels bad_pixels = BadPixels::keep;
  bool skip_uniform_light = true;  ///< tiles under uniform light are copied, which may differ in the last bit
  /// Pixels of a tile: a multiple of 16 across; 0 = what suits the device. The result does not depend on it.
  int tile_width = 0;
  int tile_height = 0;
  /// MB of device memory that a run may take, with what it copies of images: 0..1000000; 0: all that the device has.
  /// Images in host memory that need more, or a buffer larger than the device has, are filtered in bands of rows that
  /// overlap by how far light goes, with the same bits but where uniform light is skipped.
  int device_memory_mb = 0;
  /// A folder in which taps are kept for later processes, which then need not fit them: at most 64 MB, of which the
  /// longest unused go first. It is made if it is missing. A folder that can_keep_taps refuses, and files that are
  /// damaged, are as if they were not there; the result does not depend on it. Empty: nothing is kept.
  std::string cache_folder = {};

  bool operator==(const Options&) const = default;
};

/// What becomes of materials and options with a quality, a tolerance or sizes of pixels.
struct ChosenTaps {
  std::vector<Material> materials;  ///< with designs of their own, and without sizes of pixels
  Options options;                  ///< without a quality and a tolerance
  std::vector<std::size_t> missed;  ///< the materials whose taps all miss the tolerance, and which have the best ones
};

/// The choice that Plan makes, so that its plan is that of the result. Quality::reference is the exact method. Any
/// other quality and a tolerance take design_within(tolerance, taps) for materials without a design of their own. Where
/// a design has a tolerance and Material::pixel_mm is known, choose_design decides about it. Throws Error(usage) for
/// what is out of range or contradicts.
ChosenTaps choose_taps(std::vector<Material> materials, Options options);

/// Whether Options::cache_folder can be this: it is there or can be made, it belongs to the user of this process, and
/// nobody else may write to it.
bool can_keep_taps(const std::string& folder);

/// The taps of a material for pixels of one size.
struct MaterialTaps {
  TapsDesign design;            ///< with its rank
  int count = 0;                ///< per pass
  double predicted_rel_l2 = 0;  ///< as TapSet::predicted_rel_l2
};

/// The images that the frames of a plan have. No code is built for what they do not have.
struct FrameDescription {
  bool depth = false;
  bool material = false;
  bool mask = false;
  bool albedo = false;
  bool matte = false;
  bool normal = false;
  bool views = false;

  /// The description of a frame.
  static FrameDescription of(const Frame& frame);
  bool operator==(const FrameDescription&) const = default;
};

/// The way in which a run filtered or skipped a tile.
enum class TileKind : std::uint8_t {
  without_material,  ///< skipped: no pixel has a material
  narrow,            ///< skipped: every kernel is narrower than half a pixel
  unlit,             ///< skipped: no light within reach
  uniform,           ///< skipped: the same light everywhere within reach
  flat,              ///< filtered without depth terms
  curved,            ///< filtered
  reused,            ///< skipped: nothing within reach has changed since the frame before
  mixed,             ///< of blocks: filtered, and taps may fall on other materials, or beyond the frame
};

template <>
inline constexpr std::array<Named<TileKind>, 8> word_table<TileKind> = {
    {{TileKind::without_material, "without_material"},
     {TileKind::narrow, "narrow"},
     {TileKind::unlit, "unlit"},
     {TileKind::uniform, "uniform"},
     {TileKind::flat, "flat"},
     {TileKind::curved, "curved"},
     {TileKind::reused, "reused"},
     {TileKind::mixed, "mixed"}}};

/// The tiles of a run, or its blocks.
struct TileMap {
  int tile_width = 0;   ///< px
  int tile_height = 0;  ///< px; fitted to pixels that scatter and to their taps unless options give it; 16 of bands
  int columns = 0;
  int rows = 0;
  std::vector<TileKind> kinds;  ///< row by row

  /// Those of one kind.
  std::int64_t count(TileKind kind) const { return std::count(kinds.begin(), kinds.end(), kind); }
};

/// The pixels of a view, by where their surface lies.
struct ViewStats {
  std::int64_t seen = 0;           ///< the frame's camera sees it as well
  std::int64_t hidden = 0;         ///< it does not
  std::int64_t contradicting = 0;  ///< it lies in front of what the camera sees, which cannot be; of those hidden
};

/// Times and counts of one run. Times are those of the device, in milliseconds.
struct Stats {
  double prepare_ms = 0;   ///< memory, images bound to the device
  double classify_ms = 0;  ///< materials and classes of blocks
  double scatter_ms = 0;   ///< the passes, and all reading and writing of images that they do
  double views_ms = 0;     ///< light that entered where only views look
  double finish_ms = 0;    ///< outputs that had to wait for the passes
  double total_ms = 0;     ///< wall clock, transfers included

  TileMap tiles;   ///< empty if the method is not separable or the device works pixel by pixel
  TileMap blocks;  ///< 16 x 16 pixels each, of the separable method: a block is filtered by what lies around it
  int bands = 1;   ///< of rows, filtered one after the other as memory allows

  std::int64_t pixels = 0;
  std::int64_t pixels_scattered = 0;  ///< those that are bad included
  std::int64_t pixels_without_material = 0;
  std::int64_t pixels_narrow = 0;    ///< the kernel is narrower than half a pixel
  std::int64_t pixels_flat = 0;      ///< of those scattered, on blocks that need no depth terms in either pass
  std::int64_t channels_narrow = 0;  ///< of pixels scattered whose block shows one material: spread below half a pixel
  std::int64_t pixels_bad = 0;       ///< light or albedo not finite; counted where tiles are filtered
  std::int64_t pixels_unlit = 0;     ///< of those scattered by discs: skipped, without light within reach
  std::int64_t pixels_reached = 0;   ///< of those scattered: some surface that only views show is in reach
  std::vector<ViewStats> views;      ///< one for each view of the frame

  /// Tiles of one kind.
  std::int64_t count(TileKind kind) const { return tiles.count(kind); }
};

/// Called with the share of work done, 0..1. Returning false stops the run after the current step.
using Progress = std::function<bool(double)>;

/// The data that one frame of a sequence leaves for the next one: the light after scattering, 12 bytes per pixel, and a
/// hash of the inputs of each 16 x 16 pixels. For one thread at a time.
class Reuse {
 public:
  Reuse();
  ~Reuse();
  Reuse(Reuse&&) noexcept;
  Reuse& operator=(Reuse&&) noexcept;

  struct State;  ///< not for callers

 private:
  friend class Plan;
  std::unique_ptr<State> state_;
};

/// A filter, built. Immutable; may be used from several threads at once.
class Plan {
 public:
  /// Builds the kernels and places the taps. Without material ids there is exactly one material.
  /// Throws Error(usage) for options or materials outside their ranges, Error(role_missing) if they need an image that
  /// the frames do not have, Error(device) if the device refuses the kernels.
  Plan(const Device& device, std::vector<Material> materials, const FrameDescription& frames,
       const Options& options = {});
  ~Plan();
  Plan(Plan&&) noexcept;
  Plan& operator=(Plan&&) noexcept;

  /// Filters one frame of host memory or of buffers and waits for it. Writes only the pixels of the outputs.
  /// Throws Error(usage) if the frame is not as described or malformed, Error(device) on a device error.
  /// Returns without writing anything if `progress` returned false; in bands without writing those that are not done.
  Stats run(const Frame& frame, const Progress& progress = {}) const;

  /// Filters the next frame of a sequence: tiles of which nothing within reach has changed since the last run with
  /// `reuse` take the light of that run, with the same bits. All tiles are computed if there was no such run, if it was
  /// of another plan, size, camera or scale or failed, and always if the frame has views, the method is not separable
  /// or the device works pixel by pixel, or the frame runs in bands. Bad pixels are counted, and refused, in tiles that
  /// are filtered.
  Stats run(const Frame& frame, Reuse& reuse, const Progress& progress = {}) const;

  /// Puts the work of `run` on the caller's queue, which is of the plan's context and device, to start after the events
  /// in `wait_for`. All images are buffers. Never blocks. Frames of a plan share its device memory, so they run one
  /// after the other, in the order of these calls; once one is done nothing is allocated for the next. There are no
  /// bands: without the memory for all rows it throws Error(device). Throws Error(usage) also if an image is in host
  /// memory, if bad pixels are to be errors, or if the frame has views.
  Event enqueue(const Frame& frame, cl_command_queue queue, std::span<const cl_event> wait_for = {}) const;

  /// The options with what a quality or a tolerance has made of them.
  const Options& options() const;

  /// The taps of the material of this number, from 0, for pixels of this size; 0: for a kernel radius of 64 pixels.
  /// Throws Error(usage) if the method has no taps, or there is no such material or size.
  MaterialTaps taps_of(std::size_t material, double pixel_mm = 0) const;

  /// Bytes of device memory that a run needs beyond the images of the caller, and beyond what their views take.
  std::size_t scratch_bytes(int width, int height) const;

  /// The same of the plan that these would make, without building its kernels. Throws as the constructor.
  static std::size_t scratch_bytes(const Device& device, std::vector<Material> materials,
                                   const FrameDescription& frames, const Options& options, int width, int height);

  struct State;  ///< not for callers

 private:
  Stats run(const Frame& frame, Reuse::State* reuse, const Progress& progress) const;

  std::unique_ptr<const State> state_;
};

}  // namespace dermis
