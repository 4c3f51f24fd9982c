/// The beauty after scattering, put together so that it has neither noise nor values that the picture had not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "dermis/words.hpp"
#include "files/loaded_frame.hpp"

namespace dermis::program {

/// How the beauty of pixels that scatter is made.
enum class Compose {
  automatic,   ///< as the passes ask for: see choose_composition
  difference,  ///< it gains what the diffuse light has gained
  sum,         ///< the diffuse light after scattering and the other passes, added up
  beauty,      ///< the same difference, for the diffuse light that the other passes leave of the beauty
};

/// How well the passes of a picture add up to its beauty, over the pixels that scatter. Shares are of the beauty.
struct PassFit {
  std::int64_t pixels = 0;
  std::int64_t too_bright = 0;     ///< pixels whose diffuse light alone is above 1.05 of the beauty + 0.001
  double off = 0;                  ///< mean distance of the sum of passes from the beauty
  double missing = 0;              ///< what the sum lacks altogether; below 0: it is too bright
  double missing_error = 0;        ///< standard error of that
  bool beauty_is_smoother = true;  ///< than the sum of passes: by the differences of neighbours in a row
  double missing_blocks = 0;       ///< how much of the beauty is in blocks of 16 x 16 pixels where much is missing

  /// The passes add up to the beauty, pixel by pixel.
  bool adds_up() const { return off <= 0.02; }

  /// Some pixels are too bright, but no more than fireflies are. If more are, the passes are of another picture.
  bool has_fireflies() const { return too_bright > 0 && 100 * too_bright <= pixels; }

  /// They do but for noise: nothing is missing on the whole or in a place.
  bool is_complete() const {
    constexpr double of_mean = 0.01;
    const double noise = missing_error < 0.03 ? 3 * missing_error : 0;
    return missing <= of_mean + noise && -missing <= of_mean + noise && missing_blocks <= 0.005;
  }
};

/// The images that a beauty is put together from, packed RGB but for shares.
struct BeautyParts {
  const std::vector<float>& before;  ///< the beauty
  const std::vector<float>& light;   ///< the diffuse light
  const std::vector<float>& albedo;  ///< or empty
  const std::vector<float>& matte;   ///< shares; or empty
  const std::vector<float>& other;   ///< the other passes; or empty
  Lighting lighting = Lighting::raw;
  double albedo_mix = 0;
};

PassFit measure_passes(const BeautyParts& parts, int width, const std::vector<std::uint8_t>& scatters);

/// If the passes are complete but do not add up pixel by pixel, there is noise in them or in the beauty, which a
/// difference would bring in: the way that takes the light from the smoother one. Else `automatic`: a difference, which
/// keeps what is in no pass, and takes the light of fireflies from the beauty.
Compose choose_composition(const PassFit& fit);

/// Puts what the other passes leave of the beauty in place of the light: everywhere, or where the light is too bright.
/// `light` may be that of the parts.
void take_light_from_beauty(const BeautyParts& parts, const std::vector<std::uint8_t>& scatters, bool everywhere,
                            std::vector<float>& light);

/// Values that were not to be had.
struct Repairs {
  std::int64_t negative = 0;    ///< values that would have come to be below 0, and are 0
  std::int64_t not_finite = 0;  ///< values that would not have been finite, and are as they were
};

/// Whether `beauty`, the difference that the filter has made of it, has values that it should not have.
bool needs_repair(const BeautyParts& parts, const std::vector<float>& beauty);

/// Puts `beauty`, which is the difference that the filter has made of it, together again where it has changed.
/// `scattered` is the light after scattering.
Repairs compose_beauty(Compose compose, const BeautyParts& parts, const std::vector<float>& scattered,
                       std::vector<float>& beauty);

}  // namespace dermis::program

template <>
inline constexpr std::array<dermis::Named<dermis::program::Compose>, 4> dermis::word_table<dermis::program::Compose> = {
    {{dermis::program::Compose::automatic, "auto"},
     {dermis::program::Compose::difference, "difference"},
     {dermis::program::Compose::sum, "sum"},
     {dermis::program::Compose::beauty, "beauty"}}};
