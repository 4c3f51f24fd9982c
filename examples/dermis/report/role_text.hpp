/// Roles and cameras for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "dermis/exr.hpp"

namespace dermis::program {

/// "ViewLayer.DiffDir.{R,G,B} + ViewLayer.DiffInd.{R,G,B}", or "missing".
std::string text_of(const exr::ChannelSum& channels);

/// "perspective, focal length 1511.1 x 1511.1 px, centre (480, 270), from position and depth (...)"
std::string text_of(const exr::FoundCamera& found);

/// {"layer": ..., "light": [[names], ...], "mask": null, ...}
nlohmann::json json_of(const exr::Roles& roles);

nlohmann::json json_of(const exr::FoundCamera& found);

}  // namespace dermis::program
