// The named profiles and the measurements behind them.

#include "dermis/error.hpp"
#include "dermis/profile.hpp"

namespace dermis {

namespace {

constexpr const char* jensen = "Jensen et al. 2001, Table 1: sigma_s', sigma_a and diffuse albedo, as Burley's profile";

/// Burley's profile for a measured medium: mean free path l = 1 / (sigma_s' + sigma_a), d = l / s(A). The Cycles radius
/// is 4 pi l.
Profile measured(const Rgb& reduced_scattering_per_mm, const Rgb& absorption_per_mm, const Rgb& albedo) {
  constexpr double four_pi = 12.566370614359172;
  Rgb radius_mm;
  for (int c = 0; c < 3; ++c) radius_mm[c] = four_pi / (reduced_scattering_per_mm[c] + absorption_per_mm[c]);
  return Profile::burley_cycles(radius_mm, albedo);
}

constexpr const char* dipole_source = "Jensen et al. 2001, Table 1: the dipole of sigma_s' and sigma_a, eta 1.3";
constexpr const char* artist_source = "Jimenez et al. 2015, Table 2, lengths read as mm";

std::vector<Preset> make_presets() {
  return {
      {"apple", jensen, measured({2.29, 2.39, 1.97}, {.0030, .0034, .046}, {.85, .84, .53})},
      {"artist-close-fit", artist_source, Profile::artist({.034, .029, .016}, {1, .48, .2}, .37)},
      {"artist-production", artist_source, Profile::artist({.25, .08, .02}, {1, .3, .05}, .6)},
      {"chicken", jensen, measured({.15, .21, .38}, {.015, .077, .19}, {.31, .15, .10})},
      {"cream", jensen, measured({7.38, 5.47, 3.15}, {.0002, .0028, .0163}, {.98, .90, .73})},
      {"dipole-apple", dipole_source, Profile::dipole({2.29, 2.39, 1.97}, {.0030, .0034, .046})},
      {"dipole-chicken1", dipole_source, Profile::dipole({.15, .21, .38}, {.015, .077, .19})},
      {"dipole-chicken2", dipole_source, Profile::dipole({.19, .25, .32}, {.018, .088, .20})},
      {"dipole-cream", dipole_source, Profile::dipole({7.38, 5.47, 3.15}, {.0002, .0028, .0163})},
      {"dipole-ketchup", dipole_source, Profile::dipole({.18, .07, .03}, {.061, .97, 1.45})},
      {"dipole-marble", "Jensen et al. 2001, Table 1: the dipole of sigma_s' and sigma_a, eta 1.5",
       Profile::dipole({2.19, 2.62, 3.00}, {.0021, .0041, .0071}, 1.5)},
      {"dipole-potato", dipole_source, Profile::dipole({.68, .70, .55}, {.0024, .0090, .12})},
      {"dipole-skim-milk", dipole_source, Profile::dipole({.70, 1.22, 1.90}, {.0014, .0025, .0142})},
      {"dipole-skin1", dipole_source, Profile::dipole({.74, .88, 1.01}, {.032, .17, .48})},
      {"dipole-skin2", dipole_source, Profile::dipole({1.09, 1.59, 1.79}, {.013, .070, .145})},
      {"dipole-spectralon",
       "Jensen et al. 2001, Table 1: the dipole of sigma_s', eta 1.3; sigma_a is printed as 0.00, taken as 0.001",
       Profile::dipole({11.6, 20.4, 14.9}, {.001, .001, .001})},
      {"dipole-whole-milk", dipole_source, Profile::dipole({2.55, 3.21, 3.77}, {.0011, .0024, .014})},
      {"jade",
       "mental ray subsurface shader manual, table of optical properties; albedo by the dipole's diffuse reflectance",
       measured({.657, .786, .900}, {.00053, .00123, .00213}, {.88, .84, .80})},
      {"ketchup", jensen, measured({.18, .07, .03}, {.061, .97, 1.45}, {.16, .01, .00})},
      {"marble", jensen, measured({2.19, 2.62, 3.00}, {.0021, .0041, .0071}, {.83, .79, .75})},
      {"marble-walk", "the ball of the sample scene: random walk of Cycles, radius 8.5/5.6/4 mm, albedo .83/.79/.75",
       Profile::random_walk_cycles({8.5, 5.6, 4}, {.83, .79, .75})},
      {"milk", jensen, measured({2.55, 3.21, 3.77}, {.0011, .0024, .014}, {.91, .88, .76})},
      {"potato", jensen, measured({.68, .70, .55}, {.0024, .0090, .12}, {.77, .62, .21})},
      {"skim-milk", jensen, measured({.70, 1.22, 1.90}, {.0014, .0025, .0142}, {.81, .81, .69})},
      {"skin", "d'Eon and Luebke 2007, GPU Gems 3, ch. 14: six Gaussians fitted to a three-layer skin model",
       Profile::gaussians({{.0064, {.233, .455, .649}},
                           {.0484, {.100, .336, .344}},
                           {.187, {.118, .198, .000}},
                           {.567, {.113, .007, .007}},
                           {1.99, {.358, .004, .000}},
                           {7.41, {.078, .000, .000}}})},
      {"skin-measured", jensen, measured({.74, .88, 1.01}, {.032, .17, .48}, {.44, .22, .13})},
      {"skin-walk", "the head of the sample scene: random walk of Cycles, radius 9/3.5/1.8 mm, mean albedo .71/.47/.39",
       Profile::random_walk_cycles({9, 3.5, 1.8}, {.71, .47, .39})},
      {"wax", "the ring of the sample scene: Cycles radius 12/7/2 mm, albedo .8/.55/.2",
       Profile::burley_cycles({12, 7, 2}, {.80, .55, .20})},
      {"wax-walk", "the same as a random walk of Cycles", Profile::random_walk_cycles({12, 7, 2}, {.80, .55, .20})},
  };
}

}  // namespace

std::span<const Preset> presets() {
  static const std::vector<Preset> all = make_presets();
  return all;
}

const Preset& preset(std::string_view name) {
  std::string names;
  for (const Preset& candidate : presets()) {
    if (candidate.name == name) return candidate;
    names += (names.empty() ? "" : ", ") + candidate.name;
  }
  throw Error(ErrorCode::usage, "profile", name, "one of " + names);
}

}  // namespace dermis
