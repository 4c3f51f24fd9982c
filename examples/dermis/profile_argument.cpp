#include "profile_argument.hpp"

#include <filesystem>
#include <optional>
#include <vector>

#include "dermis/error.hpp"
#include "gaussian_file.hpp"
#include "number_argument.hpp"

namespace dermis::program {
namespace {

constexpr std::string_view burley_prefix = "burley:";
constexpr std::string_view gaussians_prefix = "gaussians:";
constexpr std::string_view albedo_prefix = "albedo=";

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
  if (parts[1] != "cycles" || parts.size() > 3)
    throw Error(ErrorCode::usage, argument, text,
                "burley:R/G/B, burley:R/G/B,cycles or burley:R/G/B,cycles,albedo=R/G/B");
  if (parts.size() == 2) return Profile::burley_cycles(*lengths);
  const bool named = parts[2].starts_with(albedo_prefix);
  const auto albedo = named ? parse_rgb(parts[2].substr(albedo_prefix.size())) : std::nullopt;
  if (!albedo || !all_0_to_1(*albedo))
    throw Error(ErrorCode::usage, argument, text, "albedo= and three numbers from 0 to 1, as albedo=0.8/0.6/0.5");
  return Profile::burley_cycles(*lengths, *albedo);
}

}  // namespace

Profile parse_profile(std::string_view argument, std::string_view text) {
  if (text.starts_with(burley_prefix)) return parse_burley(argument, text);
  if (text.starts_with(gaussians_prefix))
    return Profile::gaussians(read_gaussians(argument, std::string(text.substr(gaussians_prefix.size()))));
  std::string names;
  for (const Preset& known : presets()) {
    if (known.name == text) return known.profile;
    names += known.name + ", ";
  }
  throw Error(ErrorCode::usage, argument, text.empty() ? "nothing" : text,
              names + "burley:R/G/B[,cycles[,albedo=R/G/B]] or gaussians:FILE.json");
}

std::string without_folders(std::string_view text) {
  if (!text.starts_with(gaussians_prefix)) return std::string(text);
  const std::filesystem::path file(text.substr(gaussians_prefix.size()));
  return std::string(gaussians_prefix) + file.filename().string();
}

}  // namespace dermis::program
