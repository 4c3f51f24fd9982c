#include "files/beauty_composition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace dermis::program {
namespace {

/// Rounding of halves and of colours that were divided by stays below this; noise and fireflies do not.
bool is_too_bright(double diffuse, double beauty) { return diffuse > 1.05 * std::max(beauty, 0.0) + 0.001; }

double diffuse_before(const BeautyParts& parts, std::size_t i) {
  const bool is_raw = parts.lighting == Lighting::raw && !parts.albedo.empty();
  return static_cast<double>(parts.light[i]) * (is_raw ? static_cast<double>(parts.albedo[i]) : 1.0);
}

/// The albedo that is put back, as kernels/frame/light.h has it.
double diffuse_after(const BeautyParts& parts, const std::vector<float>& scattered, std::size_t i) {
  const double light = scattered[i];
  const double exponent = 1 - parts.albedo_mix;
  if (parts.albedo.empty() || exponent == 0) return light;
  const double albedo = parts.albedo[i];
  if (exponent == 1 && parts.lighting == Lighting::raw && parts.albedo_mix == 0) return albedo * light;
  return std::pow(std::max(albedo, 0.0), exponent) * light;
}

/// Sums over pixels of the beauty and of what the passes lack of it.
struct Lack {
  double pixels = 0;
  double beauty = 0;
  double lack = 0;
  double square = 0;  ///< of what a pixel lacks
  double distance = 0;

  void add(double its_beauty, double its_lack, double its_distance) {
    pixels += 1;
    beauty += its_beauty;
    lack += its_lack;
    square += its_lack * its_lack;
    distance += its_distance;
  }
  /// Standard deviation of the sum of what pixels lack, if they are independent.
  double deviation() const { return std::sqrt(std::max(0.0, square - lack * lack / std::max(pixels, 1.0))); }
};

}  // namespace

PassFit measure_passes(const BeautyParts& parts, int width, const std::vector<std::uint8_t>& scatters) {
  // A pixel that is a hundred times too bright says no more of the others than one that is ten times.
  constexpr double most = 10;
  constexpr std::size_t block = 16;
  const std::size_t columns = (static_cast<std::size_t>(width) + block - 1) / block;
  const std::size_t rows = scatters.size() / static_cast<std::size_t>(width);
  std::vector<Lack> blocks(columns * ((rows + block - 1) / block));
  Lack all;
  PassFit fit;
  double beauty_roughness = 0;
  double sum_roughness = 0;
  std::array<double, 2> before{};  // beauty and sum of passes of the last pixel that scatters
  std::size_t last = scatters.size();
  for (std::size_t pixel = 0; pixel < scatters.size(); ++pixel) {
    if (scatters[pixel] == 0) continue;
    double its_beauty = 0;
    double its_lack = 0;
    double its_distance = 0;
    bool its_too_bright = false;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
      const double beauty = parts.before[i];
      const double diffuse = diffuse_before(parts, i);
      const double sum = diffuse + (parts.other.empty() ? 0.0 : static_cast<double>(parts.other[i]));
      const double lack = beauty - std::min(sum, most * std::max(beauty, 0.0) + 0.001);
      its_too_bright = its_too_bright || is_too_bright(diffuse, beauty);
      its_beauty += beauty;
      its_lack += lack;
      its_distance += std::abs(lack);
    }
    if (!std::isfinite(its_beauty + its_lack)) continue;
    const double its_sum = its_beauty - its_lack;
    if (last + 1 == pixel && pixel % static_cast<std::size_t>(width) != 0) {
      beauty_roughness += std::abs(its_beauty - before[0]);
      sum_roughness += std::abs(its_sum - before[1]);
    }
    before = {its_beauty, its_sum};
    last = pixel;
    ++fit.pixels;
    fit.too_bright += its_too_bright ? 1 : 0;
    all.add(its_beauty, its_lack, its_distance);
    blocks[pixel / static_cast<std::size_t>(width) / block * columns + pixel % static_cast<std::size_t>(width) / block]
        .add(its_beauty, its_lack, its_distance);
  }
  if (all.beauty <= 0) return fit;
  fit.beauty_is_smoother = beauty_roughness <= sum_roughness;
  fit.off = all.distance / all.beauty;
  fit.missing = all.lack / all.beauty;
  fit.missing_error = all.deviation() / all.beauty;
  for (const Lack& one : blocks)
    if (one.lack > 0.1 * one.beauty + 4 * one.deviation()) fit.missing_blocks += one.beauty / all.beauty;
  return fit;
}

Compose choose_composition(const PassFit& fit) {
  if (fit.adds_up() || !fit.is_complete()) return Compose::automatic;
  return fit.beauty_is_smoother ? Compose::beauty : Compose::sum;
}

void take_light_from_beauty(const BeautyParts& parts, const std::vector<std::uint8_t>& scatters, bool everywhere,
                            std::vector<float>& light) {
  constexpr float smallest_albedo = 1e-4F;  // as Lighting::lit says
  const bool has_albedo = parts.lighting == Lighting::raw && !parts.albedo.empty();
  for (std::size_t pixel = 0; pixel < scatters.size(); ++pixel) {
    if (scatters[pixel] == 0) continue;
    const std::size_t first = 3 * pixel;
    bool is_taken = everywhere;
    for (std::size_t i = first; i < first + 3; ++i)
      is_taken = is_taken || is_too_bright(diffuse_before(parts, i), parts.before[i]);
    if (!is_taken) continue;
    for (std::size_t i = first; i < first + 3; ++i) {
      const float left = std::max(parts.before[i] - (parts.other.empty() ? 0.0F : parts.other[i]), 0.0F);
      if (!std::isfinite(left) || !std::isfinite(light[i]) || (has_albedo && !(parts.albedo[i] >= smallest_albedo)))
        continue;
      light[i] = has_albedo ? left / parts.albedo[i] : left;
    }
  }
}

bool needs_repair(const BeautyParts& parts, const std::vector<float>& beauty) {
  for (std::size_t i = 0; i < beauty.size(); ++i) {
    const double before = parts.before[i];
    if (beauty[i] == parts.before[i] || !std::isfinite(before)) continue;
    if (!(beauty[i] >= 0 || before < 0) || !std::isfinite(beauty[i]) || is_too_bright(diffuse_before(parts, i), before))
      return true;
  }
  return false;
}

Repairs compose_beauty(Compose compose, const BeautyParts& parts, const std::vector<float>& scattered,
                       std::vector<float>& beauty) {
  Repairs repairs;
  for (std::size_t pixel = 0; pixel < beauty.size() / 3; ++pixel) {
    const auto has_changed = [&](std::size_t i) { return beauty[i] != parts.before[i]; };
    const std::size_t first = 3 * pixel;
    if (!has_changed(first) && !has_changed(first + 1) && !has_changed(first + 2)) continue;
    const double share = parts.matte.empty() ? 1.0 : std::clamp(static_cast<double>(parts.matte[pixel]), 0.0, 1.0);
    for (std::size_t i = first; i < first + 3; ++i) {
      const double before = parts.before[i];
      const double diffuse = diffuse_before(parts, i);
      const double after = diffuse_after(parts, scattered, i);
      // Pixels that were bad stay as the filter has left them.
      if (!std::isfinite(before) || !std::isfinite(diffuse + after)) continue;
      double value = beauty[i];
      if (compose == Compose::sum) {
        const double other = parts.other.empty() ? 0.0 : static_cast<double>(parts.other[i]);
        const double sum = (1 - share) * (before - diffuse) + share * other + after;
        if (std::isfinite(sum)) value = sum;
      } else if (is_too_bright(diffuse, before)) {
        value = std::max(before - diffuse, std::min(before, 0.0)) + after;
      }
      if (!std::isfinite(static_cast<float>(value))) {
        value = before;
        ++repairs.not_finite;
      }
      if (value < 0 && before >= 0) {
        value = 0;
        ++repairs.negative;
      }
      beauty[i] = static_cast<float>(value);
    }
  }
  return repairs;
}

}  // namespace dermis::program
