#include "dermis/profile_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "dermis/error.hpp"

namespace dermis {

namespace {

constexpr std::string_view albedo_prefix = "albedo=";
constexpr std::string_view weight_prefix = "w=";
constexpr std::string_view eta_prefix = "eta=";

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// A number alone, and not an infinite one.
std::optional<double> parse_real(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  return problem == std::errc() && stop == end && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// R/G/B
std::optional<Rgb> parse_rgb(std::string_view text) {
  const auto parts = split(text, '/');
  if (parts.size() != 3) return std::nullopt;
  Rgb rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = parse_real(parts[c]);
    if (!value) return std::nullopt;
    rgb[c] = *value;
  }
  return rgb;
}

/// The number after NAME=
std::optional<double> parse_named(std::string_view text, std::string_view prefix) {
  return text.starts_with(prefix) ? parse_real(text.substr(prefix.size())) : std::nullopt;
}

bool all_above_zero(const Rgb& rgb) { return rgb[0] > 0 && rgb[1] > 0 && rgb[2] > 0; }

bool all_0_to_1(const Rgb& rgb) {
  return std::ranges::all_of(rgb, [](double value) { return value >= 0 && value <= 1; });
}

/// albedo=R/G/B
Rgb parse_albedo(const ProfileText& spelling, std::string_view text) {
  const bool named = text.starts_with(albedo_prefix);
  const auto albedo = named ? parse_rgb(text.substr(albedo_prefix.size())) : std::nullopt;
  if (!albedo || !all_0_to_1(*albedo))
    spelling.malformed("albedo= and three numbers from 0 to 1, as albedo=0.8/0.6/0.5");
  return *albedo;
}

Profile burley_of(const ProfileText& spelling, const std::vector<std::string_view>& parts) {
  const auto lengths = parse_rgb(parts[0]);
  if (!lengths || !all_above_zero(*lengths))
    spelling.malformed("burley: and three lengths in mm, each > 0, as burley:1.5/0.7/0.4");
  if (parts.size() == 1) return Profile::burley(*lengths);
  const bool path = parts[1] == "mfp";
  if ((parts[1] != "cycles" && !path) || parts.size() > 3 || (path && parts.size() < 3))
    spelling.malformed(
        "burley:R/G/B, burley:R/G/B,cycles, burley:R/G/B,cycles,albedo=R/G/B or burley:R/G/B,mfp,albedo=R/G/B");
  if (parts.size() == 2) return Profile::burley_cycles(*lengths);
  const Rgb albedo = parse_albedo(spelling, parts[2]);
  return path ? Profile::burley_mfp(*lengths, albedo) : Profile::burley_cycles(*lengths, albedo);
}

Profile parse_burley(const ProfileText& spelling) {
  auto parts = split(spelling.rest(), ',');
  if (parts.size() > 1 && parts.back() == "projected") {
    parts.pop_back();
    return burley_of(spelling, parts).projected();
  }
  return burley_of(spelling, parts);
}

Profile parse_walk(const ProfileText& spelling) {
  const auto parts = split(spelling.rest(), ',');
  const auto lengths = parse_rgb(parts[0]);
  const bool path = parts.size() == 3 && parts[1] == "mfp";
  if (!lengths || !all_above_zero(*lengths) || (parts.size() > 2 && !path))
    spelling.malformed(
        "walk:R/G/B, walk:R/G/B,albedo=R/G/B or walk:R/G/B,mfp,albedo=R/G/B, lengths in mm, each > 0, as "
        "walk:12/7/2,albedo=0.8/0.55/0.2");
  if (parts.size() == 1) return Profile::random_walk_cycles(*lengths);
  const Rgb albedo = parse_albedo(spelling, parts.back());
  return path ? Profile::random_walk_mfp(*lengths, albedo) : Profile::random_walk_cycles(*lengths, albedo);
}

Profile parse_artist(const ProfileText& spelling) {
  const auto parts = split(spelling.rest(), ',');
  const auto near_mm = parse_rgb(parts[0]);
  const auto far_mm = parts.size() == 3 ? parse_rgb(parts[1]) : std::nullopt;
  const auto weight = parts.size() == 3 ? parse_named(parts[2], weight_prefix) : std::nullopt;
  if (!near_mm || !far_mm || !weight || !all_above_zero(*near_mm) || !all_above_zero(*far_mm) || *weight < 0 ||
      *weight > 1)
    spelling.malformed(
        "artist:, twice three lengths in mm, each > 0, and a weight from 0 to 1, as "
        "artist:0.25/0.08/0.02,1/0.3/0.05,w=0.6");
  return Profile::artist(*near_mm, *far_mm, *weight);
}

template <Profile (*make)(const Rgb&, const Rgb&, double)>
Profile parse_dipole(const ProfileText& spelling) {
  const auto parts = split(spelling.rest(), ',');
  const auto scattering = parse_rgb(parts[0]);
  const auto absorption = parts.size() > 1 ? parse_rgb(parts[1]) : std::nullopt;
  if (!scattering || !absorption || !all_above_zero(*scattering) || !all_above_zero(*absorption) || parts.size() > 3) {
    const std::string prefix(spelling.prefix);
    spelling.malformed(prefix + " and twice three coefficients in 1/mm, each > 0, as " + prefix +
                       "0.74/0.88/1.01,0.032/0.17/0.48,eta=1.3");
  }
  if (parts.size() == 2) return make(*scattering, *absorption, 1.3);
  const auto eta = parse_named(parts[2], eta_prefix);
  if (!eta || *eta < 1 || *eta > 2.5) spelling.malformed("eta= and a refractive index from 1 to 2.5, as eta=1.3");
  return make(*scattering, *absorption, *eta);
}

constexpr std::array known_kinds = {
    ProfileKind{"burley:", parse_burley, false,
                "burley:R/G/B[,cycles[,albedo=R/G/B]], burley:R/G/B,mfp,albedo=R/G/B; and ,projected",
                "  burley:DR/DG/DB            Burley's diffusion, d = 1/s in mm per channel\n"
                "  burley:RR/RG/RB,cycles     Cycles' subsurface radius in mm, with the albedo of each pixel\n"
                "  burley:RR/RG/RB,cycles,albedo=AR/AG/AB\n"
                "                             the same with a constant albedo\n"
                "  burley:LR/LG/LB,mfp,albedo=AR/AG/AB\n"
                "                             mean free path in mm and albedo\n"
                "  burley:...,projected       with --view or --method exact: as Cycles samples it\n"},
    ProfileKind{"walk:", parse_walk, false, "walk:R/G/B[[,mfp],albedo=R/G/B]",
                "  walk:RR/RG/RB              Cycles' random walk, by subsurface radius in mm, albedo of each pixel\n"
                "  walk:RR/RG/RB,albedo=AR/AG/AB\n"
                "                             the same with a constant albedo\n"
                "  walk:LR/LG/LB,mfp,albedo=AR/AG/AB\n"
                "                             the same by mean free path in mm\n"},
    ProfileKind{"artist:", parse_artist, false, "artist:R/G/B,R/G/B,w=W",
                "  artist:NR/NG/NB,FR/FG/FB,w=W\n"
                "                             a near and a far Gaussian, standard deviations in mm, W of the\n"
                "                             light in the near one\n"},
    ProfileKind{"dipole:", parse_dipole<Profile::dipole>, false, "dipole:R/G/B,R/G/B[,eta=E]",
                "  dipole:SR/SG/SB,AR/AG/AB[,eta=E]\n"
                "                             a medium: reduced scattering and absorption in 1/mm, and refractive\n"
                "                             index (1.3)\n"},
    ProfileKind{"better-dipole:", parse_dipole<Profile::better_dipole>, false, "better-dipole:R/G/B,R/G/B[,eta=E]",
                "  better-dipole:SR/SG/SB,AR/AG/AB[,eta=E]\n"
                "                             the same by d'Eon's better dipole\n"},
};

}  // namespace

void ProfileText::malformed(std::string_view wanted) const { throw Error(ErrorCode::usage, argument, text, wanted); }

std::span<const ProfileKind> profile_kinds() { return known_kinds; }

const ProfileKind* kind_of(std::string_view text, std::span<const ProfileKind> kinds) {
  for (const ProfileKind& kind : kinds) {
    if (text.starts_with(kind.prefix)) return &kind;
  }
  return nullptr;
}

Profile parse_profile(std::string_view argument, std::string_view text, std::span<const ProfileKind> kinds) {
  if (const ProfileKind* kind = kind_of(text, kinds)) return kind->parse({argument, text, kind->prefix});
  std::string names;
  for (const Preset& known : presets()) {
    if (known.name == text) return known.profile;
    names += known.name + ", ";
  }
  for (const ProfileKind& kind : kinds) {
    names += kind.spellings;
    names += &kind == &kinds.back() ? "" : &kind + 1 == &kinds.back() ? " or " : ", ";
  }
  throw Error(ErrorCode::usage, argument, text.empty() ? "nothing" : text, names);
}

}  // namespace dermis
