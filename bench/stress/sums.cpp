#include "stress/sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <span>

namespace dermis::bench {

namespace {

struct Taps {
  std::vector<float> weights, values;
};

Taps random_taps(std::mt19937& engine, int count) {
  std::uniform_real_distribution<double> decade(-3, 3);
  std::uniform_real_distribution<double> noise(0.5, 1.5);
  Taps taps;
  for (int i = 0; i < count; ++i) {
    const double distance = std::abs(i - count / 2) / (0.15 * count);
    taps.weights.push_back(static_cast<float>(std::exp(-distance) * noise(engine) / count));
    taps.values.push_back(static_cast<float>(std::pow(10.0, decade(engine))));
  }
  return taps;
}

double exact_mean(const Taps& taps) {
  double sum = 0;
  double weights = 0;
  for (std::size_t i = 0; i < taps.values.size(); ++i) {
    sum += static_cast<double>(taps.weights[i]) * static_cast<double>(taps.values[i]);
    weights += static_cast<double>(taps.weights[i]);
  }
  return sum / weights;
}

using Terms = std::span<const float>;
using Sum = std::function<float(Terms)>;

float in_order(Terms terms) {
  float sum = 0;
  for (const float term : terms) sum += term;
  return sum;
}

float backwards(Terms terms) {
  float sum = 0;
  for (std::size_t i = terms.size(); i-- > 0;) sum += terms[i];
  return sum;
}

float pairwise(Terms terms) {
  if (terms.size() < 3) return in_order(terms);
  const std::size_t half = terms.size() / 2;
  return pairwise(terms.first(half)) + pairwise(terms.subspan(half));
}

/// Adds as a compiler that may reassociate does, in vectors of `lanes`.
float in_lanes(Terms terms, std::size_t lanes) {
  std::vector<float> sums(lanes, 0.0F);
  for (std::size_t i = 0; i < terms.size(); ++i) sums[i % lanes] += terms[i];
  return pairwise(sums);
}

/// Compensated summation (Kahan 1965).
float compensated(Terms terms) {
  float sum = 0;
  float lost = 0;
  for (const float term : terms) {
    const float corrected = term - lost;
    const float next = sum + corrected;
    lost = (next - sum) - corrected;
    sum = next;
  }
  return sum;
}

std::vector<float> products(const Taps& taps) {
  std::vector<float> result;
  for (std::size_t i = 0; i < taps.values.size(); ++i) result.push_back(taps.weights[i] * taps.values[i]);
  return result;
}

float mean_by(const Taps& taps, const Sum& sum) { return sum(products(taps)) / sum(taps.weights); }

float fused(const Taps& taps) {
  float sum = 0;
  for (std::size_t i = 0; i < taps.values.size(); ++i) sum = std::fma(taps.weights[i], taps.values[i], sum);
  return sum / in_order(taps.weights);
}

/// Rounds to 11 bits, without the limits of a half's exponent.
float as_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t even = (bits >> 13) & 1U;
  return std::bit_cast<float>((bits + 0xfffU + even) & ~0x1fffU);
}

float of_halfs(Taps taps) {
  for (float& value : taps.values) value = as_half(value);
  return mean_by(taps, in_order);
}

/// Keeps the sum itself in half.
float summed_in_half(const Taps& taps) {
  const auto sum = [](Terms terms) {
    float result = 0;
    for (const float term : terms) result = as_half(result + term);
    return result;
  };
  return mean_by(taps, sum);
}

/// Does what relaxed math may do: vector sums, and in place of a division a reciprocal that is off by a unit in the
/// last place.
float relaxed(const Taps& taps) {
  const float weights = in_lanes(taps.weights, 16);
  const float reciprocal = std::nextafter(1 / weights, 2 / weights);
  return in_lanes(products(taps), 16) * reciprocal;
}

struct Way {
  const char* how;
  std::function<float(const Taps&)> mean;
};

std::vector<Way> ways() {
  const auto by = [](const Sum& sum) { return [sum](const Taps& taps) { return mean_by(taps, sum); }; };
  return {{"rounded once, from double", [](const Taps& taps) { return static_cast<float>(exact_mean(taps)); }},
          {"in order", by(in_order)},
          {"in order, fused", fused},
          {"backwards", by(backwards)},
          {"4 lanes", by([](Terms terms) { return in_lanes(terms, 4); })},
          {"16 lanes", by([](Terms terms) { return in_lanes(terms, 16); })},
          {"pairwise", by(pairwise)},
          {"Kahan", by(compensated)},
          {"relaxed: 16 lanes, reciprocal 1 ulp off", relaxed},
          {"half values, float sums", of_halfs},
          {"half sums", summed_in_half}};
}

}  // namespace

std::vector<SumRow> study_sums(std::uint32_t seed, int trials) {
  std::vector<SumRow> rows;
  const std::vector<Way> all = ways();
  rows.reserve(all.size());
  for (const Way& way : all) rows.push_back({.how = way.how});
  std::mt19937 engine(seed);
  for (std::size_t s = 0; s < sum_sizes.size(); ++s) {
    for (int trial = 0; trial < trials; ++trial) {
      const Taps taps = random_taps(engine, sum_sizes[s]);
      const double truth = exact_mean(taps);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const double error = std::abs(static_cast<double>(all[i].mean(taps)) / truth - 1);
        rows[i].rms[s] += error * error / trials;
        rows[i].max[s] = std::max(rows[i].max[s], error);
      }
    }
    for (SumRow& row : rows) row.rms[s] = std::sqrt(row.rms[s]);
  }
  return rows;
}

}  // namespace dermis::bench
