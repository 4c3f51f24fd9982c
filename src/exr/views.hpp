/// The views of stereo pictures in the names of channels.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dermis::exr {

/// A name in two: the view, empty if the name has none, and the rest.
struct ViewName {
  std::string_view view;  ///< one of `views`
  std::string short_name;
};

/// The view stands before the last dot ("layer.pass.left.R", as OpenEXR has it), or first ("left.pass.R").
ViewName split_view(std::string_view channel, std::span<const std::string> views);

}  // namespace dermis::exr
