// Light that falls on a half-space walks through it and leaves it. It enters as a Lambertian surface lets it in, goes
// straight for exponentially distributed lengths of mean 1, scatters alike in all directions, and leaves where it meets
// the surface, which does not reflect, after 255 scatterings at most (Cycles gives up there, too). Walks absorb
// nothing; those that have scattered n times count a^n where the albedo of a scattering is a, so that the same walks
// serve all rows of the table.
#include "walk/walk_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace dermis::bench {

namespace {

constexpr int walk_count = 40'000'000;
constexpr int most_scatterings = 255;

constexpr int rows = 48;
constexpr int lengths = 18;
constexpr double most_absorbed = 0.8;  // Cycles has no less albedo in a scattering
// Rows are even over log(absorbed + this), below which what 255 scatterings leave hardly changes any more.
constexpr double hardly_absorbed = 1.0 / 256;

constexpr int bins_per_octave = 32;
constexpr int octaves = 15;
constexpr double nearest = 1.0 / 256;  // mean free paths; the first bin holds what is nearer, the last what is further
constexpr std::size_t bins = 1 + bins_per_octave * octaves;

using Histogram = std::vector<double>;

/// Where a bin ends.
double bin_end(std::size_t bin) { return nearest * std::exp2(static_cast<double>(bin) / bins_per_octave); }

std::size_t bin_at(double r) {
  const double bin = std::ceil(bins_per_octave * std::log2(r / nearest));
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)));
}

class Walker {
 public:
  struct Exit {
    int scatterings;
    double r;
  };

  /// One walk; none if it gives up.
  std::optional<Exit> walk() {
    const double cosine = std::sqrt(uniform());
    const double length = free_path();
    double x = std::sqrt(1 - cosine * cosine) * length;
    double y = 0;
    double depth = cosine * length;
    for (int n = 1; n <= most_scatterings; ++n) {
      const double down = 2 * uniform() - 1;
      const double aside = std::sqrt(1 - down * down);
      const double angle = 2 * std::numbers::pi * uniform();
      const double ahead = free_path();
      const bool leaves = depth + down * ahead < 0;
      const double step = leaves ? -depth / down : ahead;
      x += aside * std::cos(angle) * step;
      y += aside * std::sin(angle) * step;
      depth += down * step;
      if (leaves) return Exit{n, std::hypot(x, y)};
    }
    return std::nullopt;
  }

 private:
  /// In (0, 1), and not the library's, which may differ from one to the next.
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53 + 0x1p-54; }
  double free_path() { return -std::log(uniform()); }

  std::mt19937_64 random_{2};
};

/// Walks by the number of scatterings, one histogram after the other.
std::vector<std::uint32_t> count_walks() {
  std::vector<std::uint32_t> counts((most_scatterings + 1) * bins);
  Walker walker;
  for (int i = 0; i < walk_count; ++i) {
    if (const auto exit = walker.walk()) ++counts[static_cast<std::size_t>(exit->scatterings) * bins + bin_at(exit->r)];
  }
  return counts;
}

/// The share of the light in each bin.
Histogram light_of(const std::vector<std::uint32_t>& counts, double absorbed) {
  Histogram light(bins);
  double left = 1;
  for (std::size_t n = 1; n <= most_scatterings; ++n) {
    left *= 1 - absorbed;
    for (std::size_t bin = 0; bin < bins; ++bin) light[bin] += left * counts[n * bins + bin];
  }
  double all = 0;
  for (const double share : light) all += share;
  for (double& share : light) share /= all;
  return light;
}

/// The share of the light of an exponential in each bin.
Histogram exponential(double length) {
  Histogram share(bins);
  double beyond_last = 1;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const double beyond = bin + 1 < bins ? std::exp(-bin_end(bin) / length) : 0;
    share[bin] = beyond_last - beyond;
    beyond_last = beyond;
  }
  return share;
}

/// The weights of exponentials that are likeliest to have made the histogram, by expectation and maximisation: they
/// stay above 0, and sum to 1.
std::vector<double> fit(const Histogram& light, const std::vector<Histogram>& parts) {
  constexpr int iterations = 30'000;  // more do not change the distribution by 1e-5 any more
  std::vector<double> weights(parts.size(), 1.0 / static_cast<double>(parts.size()));
  Histogram ratio(bins);
  for (int i = 0; i < iterations; ++i) {
    std::fill(ratio.begin(), ratio.end(), 0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      for (std::size_t bin = 0; bin < bins; ++bin) ratio[bin] += weights[part] * parts[part][bin];
    }
    for (std::size_t bin = 0; bin < bins; ++bin) ratio[bin] = light[bin] / ratio[bin];
    for (std::size_t part = 0; part < parts.size(); ++part) {
      double sum = 0;
      for (std::size_t bin = 0; bin < bins; ++bin) sum += ratio[bin] * parts[part][bin];
      weights[part] *= sum;
    }
  }
  return weights;
}

/// From 1/16 on, by factors of sqrt 2.
double length_of(int i) { return std::exp2((i - 8) / 2.0); }

double absorbed_in(int row) {
  const double ratio = hardly_absorbed / (most_absorbed + hardly_absorbed);
  return (most_absorbed + hardly_absorbed) * std::pow(ratio, row / (rows - 1.0)) - hardly_absorbed;
}

/// What rounds to nothing is no term.
std::string weight_text(double weight) { return weight < 5e-7 ? "0" : fmt::format("{:.6f}", weight); }

}  // namespace

std::string make_walk_table() {
  std::vector<Histogram> parts;
  std::string text =
      "// Made by `dermis-bench --walk-table src/profile/walk_table.cpp`; bench/walk/walk_table.cpp tells how.\n"
      "#include \"profile/walk_table.hpp\"\n\nnamespace dermis {\n\n// clang-format off\n";
  text += fmt::format("const std::array<double, {}> walk_lengths = {{", lengths);
  for (int i = 0; i < lengths; ++i) {
    parts.push_back(exponential(length_of(i)));
    text += fmt::format("{}{:.17g}", i == 0 ? "" : ", ", length_of(i));
  }
  text += fmt::format("}};\n\nconst std::array<WalkRow, {}> walk_table = {{{{\n", rows);
  const std::vector<std::uint32_t> counts = count_walks();
  for (int row = 0; row < rows; ++row) {
    const double absorbed = row + 1 < rows ? absorbed_in(row) : 0;
    text += fmt::format("    {{{:.9f}, {{", absorbed);
    for (const double weight : fit(light_of(counts, absorbed), parts)) text += weight_text(weight) + ", ";
    text.erase(text.size() - 2);
    text += "}},\n";
  }
  return text + "}};\n// clang-format on\n\n}  // namespace dermis\n";
}

}  // namespace dermis::bench
