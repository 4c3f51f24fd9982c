#include "arguments/profile_argument.hpp"

#include <filesystem>
#include <optional>
#include <vector>

#include "arguments/number_argument.hpp"
#include "dermis/error.hpp"
#include "files/gaussian_file.hpp"
#include "files/table_file.hpp"

namespace dermis::program {
namespace {

constexpr std::string_view burley_prefix = "burley:";
constexpr std::string_view gaussians_prefix = "gaussians:";
constexpr std::string_view artist_prefix = "artist:";
constexpr std::string_view dipole_prefix = "dipole:";
constexpr std::string_view better_dipole_prefix = "better-dipole:";
constexpr std::string_view table_prefix = "table:";
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
  for (const double value : rgb)
    if (value < 0 || value > 1) return false;
  return true;
}

Profile parse_burley(std::string_view argument, std::string_view text) {
  const auto parts = split(text.substr(burley_prefix.size()), ',');
  const auto lengths = parse_rgb(parts[0]);
  if (!lengths || !all_above_zero(*lengths))
    throw Error(ErrorCode::usage, argument, text, "burley: and three lengths in mm, each > 0, as burley:1.5/0.7/0.4");
  if (parts.size() == 1) return Profile::burley(*lengths);
  const bool path = parts[1] == "mfp";
  if ((parts[1] != "cycles" && !path) || parts.size() > 3 || (path && parts.size() < 3))
    throw Error(ErrorCode::usage, argument, text,
                "burley:R/G/B, burley:R/G/B,cycles, burley:R/G/B,cycles,albedo=R/G/B or burley:R/G/B,mfp,albedo=R/G/B");
  if (parts.size() == 2) return Profile::burley_cycles(*lengths);
  const bool named = parts[2].starts_with(albedo_prefix);
  const auto albedo = named ? parse_rgb(parts[2].substr(albedo_prefix.size())) : std::nullopt;
  if (!albedo || !all_0_to_1(*albedo))
    throw Error(ErrorCode::usage, argument, text, "albedo= and three numbers from 0 to 1, as albedo=0.8/0.6/0.5");
  return path ? Profile::burley_mfp(*lengths, *albedo) : Profile::burley_cycles(*lengths, *albedo);
}

Profile parse_artist(std::string_view argument, std::string_view text) {
  const auto parts = split(text.substr(artist_prefix.size()), ',');
  const auto near_mm = parse_rgb(parts[0]);
  const auto far_mm = parts.size() == 3 ? parse_rgb(parts[1]) : std::nullopt;
  const auto weight = parts.size() == 3 ? parse_named(parts[2], weight_prefix) : std::nullopt;
  if (!near_mm || !far_mm || !weight || !all_above_zero(*near_mm) || !all_above_zero(*far_mm) || *weight < 0 ||
      *weight > 1)
    throw Error(ErrorCode::usage, argument, text,
                "artist:, twice three lengths in mm, each > 0, and a weight from 0 to 1, as "
                "artist:0.25/0.08/0.02,1/0.3/0.05,w=0.6");
  return Profile::artist(*near_mm, *far_mm, *weight);
}

using MakeDipole = Profile (*)(const Rgb&, const Rgb&, double);

Profile parse_dipole(std::string_view argument, std::string_view text, std::string_view prefix, MakeDipole make) {
  const auto parts = split(text.substr(prefix.size()), ',');
  const auto scattering = parse_rgb(parts[0]);
  const auto absorption = parts.size() > 1 ? parse_rgb(parts[1]) : std::nullopt;
  if (!scattering || !absorption || !all_above_zero(*scattering) || !all_above_zero(*absorption) || parts.size() > 3)
    throw Error(ErrorCode::usage, argument, text,
                std::string(prefix) + " and twice three coefficients in 1/mm, each > 0, as " + std::string(prefix) +
                    "0.74/0.88/1.01,0.032/0.17/0.48,eta=1.3");
  if (parts.size() == 2) return make(*scattering, *absorption, 1.3);
  const auto eta = parse_named(parts[2], eta_prefix);
  if (!eta || *eta < 1 || *eta > 2.5)
    throw Error(ErrorCode::usage, argument, text, "eta= and a refractive index from 1 to 2.5, as eta=1.3");
  return make(*scattering, *absorption, *eta);
}

}  // namespace

Profile parse_profile(std::string_view argument, std::string_view text) {
  if (text.starts_with(burley_prefix)) return parse_burley(argument, text);
  if (text.starts_with(gaussians_prefix))
    return Profile::gaussians(read_gaussians(argument, std::string(text.substr(gaussians_prefix.size()))));
  if (text.starts_with(artist_prefix)) return parse_artist(argument, text);
  if (text.starts_with(dipole_prefix)) return parse_dipole(argument, text, dipole_prefix, Profile::dipole);
  if (text.starts_with(better_dipole_prefix))
    return parse_dipole(argument, text, better_dipole_prefix, Profile::better_dipole);
  if (text.starts_with(table_prefix))
    return Profile::tabulated(read_table(argument, std::string(text.substr(table_prefix.size()))));
  std::string names;
  for (const Preset& known : presets()) {
    if (known.name == text) return known.profile;
    names += known.name + ", ";
  }
  throw Error(ErrorCode::usage, argument, text.empty() ? "nothing" : text,
              names +
                  "burley:R/G/B[,cycles[,albedo=R/G/B]], burley:R/G/B,mfp,albedo=R/G/B, gaussians:FILE.json, "
                  "artist:R/G/B,R/G/B,w=W, dipole:R/G/B,R/G/B[,eta=E], better-dipole:R/G/B,R/G/B[,eta=E] or "
                  "table:FILE.csv");
}

std::string without_folders(std::string_view text) {
  for (const std::string_view prefix : {gaussians_prefix, table_prefix}) {
    if (!text.starts_with(prefix)) continue;
    const std::filesystem::path file(text.substr(prefix.size()));
    return std::string(prefix) + file.filename().string();
  }
  return std::string(text);
}

}  // namespace dermis::program
