/// One frame under several methods, side by side.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::program {

/// A frame under one method.
struct MethodPicture {
  std::string name;
  std::vector<float> beauty;     ///< RGB
  std::vector<float> scattered;  ///< RGB: light after scattering; empty if it is not known
};

/// Draws the pictures in a row, and under each how far its scattered light is from that of the last one that has any,
/// as a map and as relative L2 over the pixels that the last one changes from the first; and how far its beauty is from
/// that of the last picture if that has no scattered light, for it is the path tracer's. `argument` is named in errors.
/// Throws Error(output).
void draw_methods(std::string_view argument, const std::filesystem::path& path, int width, int height,
                  const std::vector<MethodPicture>& pictures);

}  // namespace dermis::program
