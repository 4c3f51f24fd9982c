/// Scattering in texture space (Borshukov and Lewis 2003; d'Eon, GDC 2007; d'Eon and Luebke, GPU Gems 3, ch. 14): light
/// that lies in a UV layout is blurred along u and along v, as far as the surface under each texel says.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/event.hpp"
#include "dermis/frame.hpp"
#include "dermis/profile.hpp"
#include "dermis/words.hpp"

namespace dermis {

/// Light in a UV layout. All images have its size; u runs along rows, v along columns. A texel is empty, and neither
/// gives nor takes light, if its mask is not above 0, its light or albedo is not finite, or a stretch of it is not in
/// 1e-9..1e9 mm. Along each axis the texels between two empty ones, or the edges of the texture, are a run: a piece of
/// one chart. Light does not leave its run, so charts need no padding and two charts that touch need an empty texel
/// between them; it is mirrored at the ends (no flux), so constant light stays what it is and a seam is no dark line.
struct TextureFrame {
  int width = 0;
  int height = 0;
  Image light = {};         ///< RGB, f16 or f32: irradiance, without the albedo
  Image albedo = {};        ///< RGB, f16 or f32
  Image mask = {};          ///< 1 channel, f16 or f32: above 0 on objects
  Image stretch_u = {};     ///< 1 channel, f16 or f32: mm of surface that a texel spans along u, |dP/du|
  Image stretch_v = {};     ///< the same along v; both or none
  double mm_per_texel = 1;  ///< of all texels along both axes, where there are no stretches; 1e-9..1e9

  OutputImage scattered = {};  ///< RGB, f16 or f32: light after scattering; an empty texel has its light
  OutputImage result = {};     ///< RGB, f16 or f32: with the albedo put back; an empty texel has its light
};

/// The images that the frames of a plan have.
struct TextureDescription {
  bool albedo = false;
  bool mask = false;
  bool stretch = false;

  static TextureDescription of(const TextureFrame& frame) {
    return {.albedo = static_cast<bool>(frame.albedo),
            .mask = static_cast<bool>(frame.mask),
            .stretch = static_cast<bool>(frame.stretch_u) || static_cast<bool>(frame.stretch_v)};
  }
  bool operator==(const TextureDescription&) const = default;
};

enum class TextureMethod {
  gaussians,  ///< a sum of six Gaussians, each made from the one before: see GaussianChain
  recursive,  ///< exponentials, in a time that does not depend on their length: see Recursion
};

template <>
inline constexpr std::array<Named<TextureMethod>, 2> word_table<TextureMethod> = {
    {{TextureMethod::gaussians, "gaussians"}, {TextureMethod::recursive, "recursive"}}};

struct TextureOptions {
  TextureMethod method = TextureMethod::gaussians;
  /// m in 0..1: albedo^m is put in before the blur, albedo^(1-m) after. The talk's `mix` is the same number: 0.82
  /// there.
  double albedo_mix = 0;

  bool operator==(const TextureOptions&) const = default;
};

/// A profile as Gaussians of the plane, per channel by ascending variance, most of them made from the one before by a
/// blur of the difference of variances (d'Eon, GDC 2007; GPU Gems 3, section 14.4.3). At a texel of stretch s
///
///     blur_k(i) = sum_o w_o source(i + o n) / sum_o w_o,    |o| <= taps
///
/// along u, then along v, i + o n mirrored at the ends of the run; the result is the sum over k of weight_k blur_k. The
/// first Gaussian, and those of a deviation of at most `narrow` of the smallest stretch of all texels, are made from
/// the light itself, by the share of the Gaussian that falls on each texel:
///
///     w_o = erf((o + 1/2) s / sqrt(2 d)) - erf((o - 1/2) s / sqrt(2 d)),   d = variance_k,   n = 1
///
/// and the others from blur_(k-1), which is smooth, so that a few taps will do:
///
///     w_o = exp(-(o n s)^2 / (2 d)),   d = variance_k - variance_(k-1)
///     n = the largest whole number with n s <= spacing sqrt(d), at least 1
///
/// taps is the smallest whole number with taps n s >= reach sqrt(d), at least 1. A sqrt(d) of more than most_texels
/// counts as that many. The products in n and taps are those of float32.
struct GaussianChain {
  std::array<std::vector<double>, 3> variances_mm2;
  std::array<std::vector<double>, 3> weights;  ///< >= 0; of each channel they sum to 1
  /// Expected relative L2 distance of the sum from the profile over natural images, as TapSet::predicted_rel_l2.
  double predicted_rel_l2 = 0;

  static constexpr float narrow = 2;
  static constexpr float spacing = 0.75F;
  static constexpr float reach = 4;
  static constexpr float most_texels = 1024;
};

/// Two exponentials of a function f(x) of one channel, f being the sum over its pairs. Of real rates, turn 0,
///
///     share_0 g(rate_0) + share_1 g(rate_1),    g(gamma) = gamma / 2 exp(-gamma |x|)
///
/// and else, both rates being equal, the real part of (share_0 + i share_1) g(rate_0 + i turn).
struct PolePair {
  std::array<double, 2> rate_per_mm{1, 1};
  double turn_per_mm = 0;
  std::array<double, 2> share{0, 0};
};

/// A profile as two products of sums of exponentials, R(sqrt(x^2 + y^2)) ~ f(x) f(y) + sign h(x) h(y), where the
/// integral of f is 1 and that of h is 0. Over light that is constant on each texel, at the middles of texels, along
/// the surface from texel to texel, mirrored at the ends of the run, such sums are exact by recursion, whatever the
/// stretches: from one border of a texel to the next, z = exp(-gamma s), the state of a pole becomes z state + (1 - z)
/// light; its result is the mean of what its states from both sides become half a texel on (Deriche 1993, in parallel
/// form). An exponential counts as at most 2^14 texels long.
struct Recursion {
  static constexpr int pairs = 2;
  using Function = std::array<PolePair, pairs>;

  std::array<Function, 3> main;        ///< f of each channel
  std::array<Function, 3> correction;  ///< h
  Rgb sign{1, 1, 1};
  /// Expected relative L2 distance of the products from the profile over natural images, as TapSet::predicted_rel_l2.
  double predicted_rel_l2 = 0;

  static constexpr double worst_rel_l2 = 0.02;
};

/// The six Gaussians of a profile.
GaussianChain make_gaussian_chain(const Profile& profile);

/// The four poles of each function of a profile. Throws Error(usage) if they would be worse than worst_rel_l2.
Recursion make_recursion(const Profile& profile);

/// Counts and times of one run. Times are those of the device, in milliseconds.
struct TextureStats {
  double prepare_ms = 0;  ///< the light and the runs of texels
  double scatter_ms = 0;  ///< the passes
  double finish_ms = 0;   ///< the outputs
  double total_ms = 0;    ///< wall clock, transfers included

  std::int64_t texels = 0;
  std::int64_t texels_empty = 0;
  /// Parts that the passes consist of: blocks of 64 x 16 texels in each blur, or rows and columns (recursive).
  std::int64_t parts = 0;
  std::int64_t parts_empty = 0;  ///< skipped: no texel of an object
  std::int64_t parts_unlit = 0;  ///< skipped: no light within reach
};

/// A filter for textures, built. Immutable; may be used from several threads at once.
class TexturePlan {
 public:
  /// Fits the profile and builds the kernels. Throws Error(usage) for options outside their ranges, a profile whose
  /// width follows the albedo or that recursion cannot follow, Error(role_missing) for an albedo_mix above 0 without an
  /// albedo, Error(device) if the device refuses the kernels.
  TexturePlan(const Device& device, const Profile& profile, const TextureDescription& frames,
              const TextureOptions& options = {});
  ~TexturePlan();
  TexturePlan(TexturePlan&&) noexcept;
  TexturePlan& operator=(TexturePlan&&) noexcept;

  /// Filters one texture of host memory or of buffers and waits for it. Writes only the texels of the outputs, which
  /// may lie over the inputs. Throws Error(usage) if the frame is not as described or malformed, Error(role_missing)
  /// for a result without an albedo, Error(device) on a device error.
  TextureStats run(const TextureFrame& frame) const;

  /// Puts the work of `run` on the caller's queue, as Plan::enqueue does. All images are buffers. Never blocks.
  Event enqueue(const TextureFrame& frame, cl_command_queue queue, std::span<const cl_event> wait_for = {}) const;

  /// The error to expect of the fit to the profile, before discretisation: as TapSet::predicted_rel_l2.
  double predicted_rel_l2() const;

  struct State;  ///< not for callers

 private:
  std::unique_ptr<const State> state_;
};

/// mm of surface per texel along u and along v.
struct StretchMaps {
  std::vector<float> u, v;
};

/// The stretches of a layout whose texels have these positions: the mean of the distances to both neighbours along the
/// axis that are not empty, the distance to the only one, or 1 if there is none. `position`: XYZ, f16 or f32, scene
/// units; `mask`: 1 channel, or none. Texels are empty where the mask is not above 0 or the position is not finite.
/// Reads host memory. Throws Error(usage) for a size, a scale or an image that it cannot read.
StretchMaps stretch_of_positions(int width, int height, const Image& position, const Image& mask, double mm_per_unit);

}  // namespace dermis
