#include "taps/kept/kept_taps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

#include "profile/profile_content.hpp"
#include "taps/check_design.hpp"
#include "taps/kept/kept_files.hpp"
#include "taps/kept/packed.hpp"
#include "taps/kept/taps_build.hpp"

namespace dermis {

namespace {

/// All that a choice adds to the design that is wanted.
struct KeptChoice {
  int rank = 0;
  int count = 0;
  double predicted_rel_l2 = 0;
};

template <class Value, class Type>
concept Is = std::same_as<std::remove_const_t<Value>, Type>;

void fields(auto& bytes, Is<KeptChoice> auto& its) { bytes(its.rank, its.count, its.predicted_rel_l2); }

}  // namespace

// Where Packed and Unpacked find them: beside the structs.

void fields(auto& bytes, Is<Term> auto& its) { bytes(its.scale, its.normalised, its.sum); }

void fields(auto& bytes, Is<Nearness> auto& its) { bytes(its.scale, its.softening, its.end); }

void fields(auto& bytes, Is<TapLevel> auto& its) {
  bytes(its.px_per_mm, its.offsets_px, its.nearness, its.weights, its.flat_weights);
}

void fields(auto& bytes, Is<Taps> auto& its) { bytes(its.radius_mm, its.relative_width, its.terms, its.levels); }

void fields(auto& bytes, const TapsDesign& its) {
  bytes(its.model, its.rank, its.count, its.placement, its.non_negative, its.guide, its.tolerance, its.widest_px);
}

void fields(auto& bytes, const ProfileContent& its) {
  bytes(its.kinds, its.numbers, its.albedo_width, its.is_projected);
}

namespace {

/// A hash of what the mathematical functions return here: it may differ between versions of the C library and between
/// processors, and taps differ with it.
std::uint64_t mathematics() {
  static const std::uint64_t hash = [] {
    Packed values;
    for (int i = 1; i <= 100; ++i) {
      const double x = i * 0.137;
      values(std::exp(-x), std::expm1(-x), std::exp2(x), std::log(x), std::log1p(x), std::log2(x), std::pow(x, 1.3),
             std::hypot(x, 1.0), std::sin(x), std::cos(x), std::sinh(x), std::cosh(x), std::asinh(x), std::erf(x / 4),
             std::erfc(x / 4), std::cbrt(x));
    }
    return checksum(values.bytes());
  }();
  return hash;
}

/// Everything that the result depends on. `what` is a name for the function.
template <class... Arguments>
std::string key_of(const char* what, const Profile& profile, const Arguments&... arguments) {
  Packed key;
  key(std::string(taps_build), mathematics(), std::string(what), content_of(profile), arguments...);
  return key.bytes();
}

/// What is kept under the key, if it is sound, else what make() returns, which is kept then.
template <class Value, class Make, class IsSound>
Value kept(const std::string& folder, const std::string& key, const IsSound& is_sound, const Make& make) {
  const KeptFiles files(folder);
  if (const std::optional<std::string> bytes = files.get(key)) {
    Value value{};
    Unpacked unpacked(*bytes);
    unpacked(value);
    if (unpacked.complete() && is_sound(value)) return value;
  }
  Value value = make();
  Packed packed;
  packed(value);
  files.put(key, packed.bytes());
  return value;
}

bool is_rank(int rank, const TapsDesign& design) { return rank >= 1 && rank <= highest_rank(design.model); }

template <class Rows>
bool all_finite(const Rows& rows) {
  if constexpr (std::is_floating_point_v<Rows>) {
    return std::isfinite(rows);
  } else {
    return std::all_of(rows.begin(), rows.end(), [](const auto& row) { return all_finite(row); });
  }
}

bool is_sound_level(const TapLevel& level, std::size_t terms) {
  constexpr int widest_px = static_cast<int>(Taps::min_radius_px * (1 << Taps::octaves));
  const std::vector<int>& offsets = level.offsets_px;
  const std::size_t rows = offsets.size() + 1;
  const bool ascends = std::adjacent_find(offsets.begin(), offsets.end(), std::greater_equal()) == offsets.end();
  return ascends && (offsets.empty() || (offsets.front() > 0 && offsets.back() <= widest_px)) &&
         std::isfinite(level.px_per_mm) && level.nearness.size() == rows && level.weights.size() == rows * terms &&
         all_finite(level.weights) &&
         std::all_of(level.nearness.begin(), level.nearness.end(),
                     [](const Nearness& n) {
                       return std::isfinite(n.scale) && n.softening > 0 && std::isfinite(n.softening) &&
                              std::isfinite(n.end);
                     }) &&
         std::all_of(level.flat_weights.begin(), level.flat_weights.end(),
                     [&](const auto& part) { return part.size() == rows * terms && all_finite(part); });
}

/// Kernels read what these say without another look.
bool is_sound_table(const Taps& taps, int rank) {
  constexpr std::size_t levels = Taps::octaves << Taps::log2_levels_per_octave;
  const auto terms = static_cast<std::size_t>(rank);
  return taps.radius_mm > 0 && std::isfinite(taps.radius_mm) && all_finite(taps.relative_width) &&
         taps.terms.size() == terms && taps.terms.front().normalised &&
         std::all_of(taps.terms.begin(), taps.terms.end(),
                     [](const Term& term) { return all_finite(term.scale) && all_finite(term.sum); }) &&
         taps.levels.size() == levels &&
         std::all_of(taps.levels.begin(), taps.levels.end(),
                     [&](const TapLevel& level) { return is_sound_level(level, terms); });
}

}  // namespace

bool can_keep_taps(const std::string& folder) { return KeptFiles(folder).is_usable(); }

DesignChoice kept_choice(const std::string& folder, const Profile& profile, const TapsDesign& wanted, double pixel_mm) {
  if (folder.empty()) return choose_design(profile, wanted, pixel_mm);
  const auto is_sound = [&](const KeptChoice& its) {
    return is_rank(its.rank, wanted) && its.count >= wanted.count && its.count <= most_taps && its.count % 2 == 1 &&
           its.predicted_rel_l2 >= 0;
  };
  const auto its = kept<KeptChoice>(folder, key_of("choose_design", profile, wanted, pixel_mm), is_sound, [&] {
    const DesignChoice choice = choose_design(profile, wanted, pixel_mm);
    return KeptChoice{choice.design.rank, choice.design.count, choice.predicted_rel_l2};
  });
  DesignChoice choice{wanted, its.predicted_rel_l2};
  choice.design.rank = its.rank;
  choice.design.count = its.count;
  return choice;
}

TapsDesign kept_with_rank(const std::string& folder, const Profile& profile, const TapsDesign& design) {
  if (folder.empty() || design.rank > 0) return with_rank(profile, design);
  TapsDesign result = design;
  result.rank = kept<int>(
      folder, key_of("with_rank", profile, design), [&](int rank) { return is_rank(rank, design); },
      [&] { return with_rank(profile, design).rank; });
  return result;
}

Taps kept_taps(const std::string& folder, const Profile& profile, const TapsDesign& design) {
  if (folder.empty()) return make_taps(profile, design);
  const TapsDesign ranked = kept_with_rank(folder, profile, design);
  return kept<Taps>(
      folder, key_of("make_taps", profile, ranked), [&](const Taps& taps) { return is_sound_table(taps, ranked.rank); },
      [&] { return make_taps(profile, ranked); });
}

}  // namespace dermis
