// Stages with a work-item for each pixel. Their kernels are built for scalars on every device, for gathers dominate.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "opencl/image_buffers.hpp"
#include "opencl/opencl.hpp"

namespace dermis {

inline std::string scalar_build_options() { return "-cl-std=CL1.2 -DV=1"; }

/// An output and the input whose place it may take; -1 for none.
struct OutputPlace {
  int output;
  int may_replace;
};

/// Throws Error(usage) if an output lies over another image in any other way: pixels are read while others are written.
inline void check_outputs(const ImageBuffers& memory, std::span<const CallerImage> images,
                          std::initializer_list<OutputPlace> places) {
  for (const auto& [output, may_replace] : places) {
    for (int other = 0; other < static_cast<int>(images.size()); ++other) {
      if (other == output || !memory.overlap(output, other)) continue;
      if (other == may_replace && memory.same_place(output, other)) continue;
      throw Error(ErrorCode::usage, images[output].name, std::string("memory of ") + images[other].name,
                  may_replace < 0 ? std::string("memory of its own")
                                  : std::string("memory of its own, or that of ") + images[may_replace].name +
                                        " in the same layout");
    }
  }
}

}  // namespace dermis
