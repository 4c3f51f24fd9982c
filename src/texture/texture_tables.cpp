#include "texture/texture_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace dermis {

namespace {

constexpr double longest_texels = 0x1p14;  // as LEAST_HALF_TEXEL of recursion.cl

/// As in texture_blur.cl.
int steps_within(float mm, float most) {
  float n = std::floor(most / mm);
  if ((n + 1) * mm <= most) ++n;
  if (n * mm > most) --n;
  return std::max(static_cast<int>(n), 1);
}

int steps_beyond(float mm, float least) {
  float n = std::ceil(least / mm);
  if ((n - 1) * mm >= least) --n;
  if (n * mm < least) ++n;
  return std::max(static_cast<int>(n), 1);
}

void place_taps(params::BlurParams& blur, std::vector<float>& weights, float mm_per_texel) {
  blur.from_light = blur.is_first != 0 || blur.total_deviation_mm <= GaussianChain::narrow * mm_per_texel ? 1 : 0;
  const float deviation_mm = blur.from_light != 0 ? blur.total_deviation_mm : blur.deviation_mm;
  const float mm = std::max(mm_per_texel, deviation_mm * (1 / GaussianChain::most_texels));
  blur.step = blur.from_light != 0 ? 1 : steps_within(mm, GaussianChain::spacing * deviation_mm);
  const float step_mm = static_cast<float>(blur.step) * mm;
  blur.taps = steps_beyond(step_mm, GaussianChain::reach * deviation_mm);
  blur.first_weight = static_cast<int>(weights.size());
  const double step = static_cast<double>(step_mm) / static_cast<double>(deviation_mm);
  const auto up_to = [&](double o) { return std::erf(o * step / std::numbers::sqrt2); };
  const auto share = [&](int o) {
    if (blur.from_light != 0) return o == 0 ? 2 * up_to(0.5) : up_to(o + 0.5) - up_to(o - 0.5);
    return o == 0 ? 1 : std::exp(-o * step * (o * step) / 2);
  };
  double sum = share(0);
  for (int o = 1; o <= blur.taps; ++o) sum += 2 * share(o);
  for (int o = 0; o <= blur.taps; ++o) weights.push_back(static_cast<float>(share(o) / sum));
}

/// Over so much of a texel.
void set_decay(float (&decay)[3][STATES], int lane, const PolePair& pair, double mm_per_texel, double part) {
  const auto length = [&](double rate) { return part * std::max(mm_per_texel, 1 / (rate * longest_texels)); };
  const auto decayed = [&](double rate) { return std::exp(-rate * length(rate)); };
  const double angle = pair.turn_per_mm * length(pair.rate_per_mm[0]);
  decay[0][lane] = static_cast<float>(decayed(pair.rate_per_mm[0]) * std::cos(angle));
  decay[1][lane] = static_cast<float>(decayed(pair.rate_per_mm[1]) * std::cos(angle));
  decay[2][lane] = static_cast<float>(-decayed(pair.rate_per_mm[0]) * std::sin(angle));
}

}  // namespace

BlurTables make_blur_tables(const GaussianChain& chain, double mm_per_texel) {
  BlurTables tables;
  for (std::size_t k = 0; k < chain.weights.front().size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const std::vector<double>& variances = chain.variances_mm2[c];
      const double variance = variances[k] - (k > 0 ? variances[k - 1] : 0);
      params::BlurParams blur{};
      blur.total_deviation_mm = static_cast<float>(std::sqrt(variances[k]));
      blur.variance_mm2 = static_cast<float>(variance);
      blur.deviation_mm = static_cast<float>(std::sqrt(variance));
      blur.weight = static_cast<float>(chain.weights[c][k]);
      blur.is_first = k == 0 ? 1 : 0;
      if (mm_per_texel > 0) place_taps(blur, tables.weights, static_cast<float>(mm_per_texel));
      tables.blurs.push_back(blur);
    }
  }
  if (tables.weights.empty()) tables.weights.push_back(0);
  return tables;
}

std::array<params::PoleParams, 2> make_pole_tables(const Recursion& recursion, double mm_per_texel) {
  std::array<params::PoleParams, 2> tables{};
  for (int pass = 0; pass < 2; ++pass) {
    params::PoleParams& table = tables[pass];
    std::fill_n(table.rate, STATES, 1.0F);
    std::fill_n(table.other_rate, STATES, 1.0F);
    for (int k = 0; k < Recursion::pairs; ++k) {
      for (int function = 0; function < 2; ++function) {
        for (int c = 0; c < 3; ++c) {
          const int lane = 8 * k + 4 * function + c;
          const PolePair& pair = (function == 0 ? recursion.main : recursion.correction)[c][k];
          const double sign = pass == 1 && function == 1 ? recursion.sign[c] : 1;
          // The result of a complex pair is the real part of its share times p + i q.
          const double other_sign = pair.turn_per_mm > 0 ? -sign : sign;
          table.rate[lane] = static_cast<float>(pair.rate_per_mm[0]);
          table.other_rate[lane] = static_cast<float>(pair.rate_per_mm[1]);
          table.turn[lane] = static_cast<float>(pair.turn_per_mm);
          table.share[lane] = static_cast<float>(sign * pair.share[0]);
          table.other_share[lane] = static_cast<float>(other_sign * pair.share[1]);
          if (mm_per_texel > 0) {
            set_decay(table.half_texel, lane, pair, mm_per_texel, 0.5);
            set_decay(table.texel, lane, pair, mm_per_texel, 1);
          }
        }
      }
    }
  }
  return tables;
}

}  // namespace dermis
