// The profiles and pictures that the claims are measured on, and the figures that measure them.
#pragma once

#include <filesystem>
#include <functional>

#include "paper/claim.hpp"
#include "paper/pictures.hpp"
#include "paper/svd.hpp"

namespace dermis::bench {

/// A profile at the main width, with the models that several figures need.
struct Medium {
  Sample sample;
  Products rank_1;  ///< pre-integrated
  Svd svd;
};

struct Study {
  std::vector<Medium> media;  ///< at width_px; skin first, then one of Burley's, then dipoles
  std::vector<Sample> wider;  ///< skin and Burley's at twice the width
  Pictures natural;
  Pictures dot;
  std::filesystem::path folder;  ///< figures go here

  const Medium& skin() const { return media[0]; }
};

inline constexpr double width_px = 16;
inline constexpr double dot_radius_px = 3;
inline constexpr double good_enough = 0.01;  // relative L2
inline constexpr const char* channel_names[] = {"red", "green", "blue"};

/// Makes all of it. `report` is told what is going on.
Study make_study(const std::filesystem::path& folder, const std::function<void(const std::string&)>& report);

// Each of these draws its figure and judges its claims.
Claims fig2(const Study& study);
Claims fig4(const Study& study);
Claims fig5(const Study& study);
Claims fig7(const Study& study);
Claims fig11(const Study& study);
// These judge claims without a figure.
Claims table2(const Study& study);
Claims edges(const Study& study);
Claims guided(const Study& study);

}  // namespace dermis::bench
