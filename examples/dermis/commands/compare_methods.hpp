/// --compare-methods: one frame under each method, side by side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dermis/device.hpp"
#include "dermis/frame.hpp"
#include "dermis/plan.hpp"
#include "files/loaded_frame.hpp"

namespace dermis::program {

/// A frame under one method.
struct MethodPicture {
  std::string name;
  std::vector<float> beauty;     ///< RGB
  std::vector<float> scattered;  ///< RGB: light after scattering; empty if it is not known
};

/// The frame as it is, by the rule of 2012, by the separable method of ranks 1 and 2 with 17 taps, by discs of 55
/// samples, and by the exact method. `frame` is `loaded`, of raw light and with albedo, with the beauty that is given
/// besides; its outputs are not touched. `options` are those that hold for all. Says on stderr what it works on.
std::vector<MethodPicture> picture_methods(const Device& device, const std::vector<Material>& materials,
                                           const Frame& frame, const LoadedFrame& loaded, std::vector<float> beauty,
                                           const Options& options);

/// Draws the pictures in a row, and under each how far its scattered light is from that of the last one that has any,
/// as a map and as relative L2 over the pixels that one changes; and how far its beauty is from that of the last
/// picture if that has no scattered light. Throws Error(output) that names `argument`.
void draw_methods(const char* argument, const std::filesystem::path& path, int width, int height,
                  const std::vector<MethodPicture>& pictures);

}  // namespace dermis::program
