/// The channels that a result of `dermis filter` has.
#pragma once

#include <string>
#include <vector>

#include "arguments/filter_arguments.hpp"
#include "commands/surface_input.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// The attribute that names the passes of scattered light, so that the next run knows it for its own.
inline constexpr const char* scattered_attribute = "dermis:scattered";

/// The name of a group of channels without its last part.
std::string pass_of(const std::vector<std::string>& channels);

/// The channels for the scattered light: those of "sss", or of another pass if the renderer has one of that name, which
/// is said.
std::vector<std::string> scattered_channels(const exr::Picture& picture, const exr::Roles& roles, Messages& messages);

/// The channels of the result.
struct ResultChannels {
  std::vector<std::string> scattered;
  std::vector<std::string> beauty;   ///< or none
  std::vector<std::string> written;  ///< none stands for all
};

/// Says where the scattered light goes if that is not the usual place. Throws Error(usage) if the beauty is not one
/// group of three.
ResultChannels result_channels(OutputLayers layers, const SurfaceInput& input, Messages& messages);

}  // namespace dermis::program
