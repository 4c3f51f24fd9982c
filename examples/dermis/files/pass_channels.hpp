/// The channels of passes that the program writes.
#pragma once

#include <string>
#include <vector>

#include "dermis/exr.hpp"

namespace dermis::program {

/// "ViewLayer.sss.R", G and B: those of a pass of that name in the layer of the roles; "ViewLayer.sss.left.R" if they
/// are of a view.
inline std::vector<std::string> channels_of_pass(const exr::Roles& roles, const std::string& name) {
  const std::string prefix =
      (roles.layer.empty() ? "" : roles.layer + ".") + name + (roles.view.empty() ? "" : "." + roles.view);
  return {prefix + ".R", prefix + ".G", prefix + ".B"};
}

}  // namespace dermis::program
