/// How far a result is from path-traced pictures of the same view.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace dermis::program {

struct TruthArguments {
  std::string result;               ///< of `dermis filter`, or a G-buffer: its light is what no scattering shows
  std::vector<std::string> truths;  ///< one, or two of other seeds
  std::string mask_channel;         ///< NAME=VALUE, in the result; or empty
};

/// Prints the relative L2 error of each material and of all pixels (without material 0, if there are others), of the
/// diffuse light without the albedo of the result, or of the beauty if a truth has no diffuse light. Returns that of
/// all pixels. Throws Error(role_missing) for what a picture lacks, Error(input_unsupported) if the windows differ.
double print_truth_error(const TruthArguments& arguments);

}  // namespace dermis::program
