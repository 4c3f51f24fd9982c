/// A picture of the same frame from elsewhere, which shows surface that its camera does not see.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "arguments/surface_arguments.hpp"
#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "dermis/frame.hpp"
#include "dermis/plan.hpp"
#include "files/frame_names.hpp"
#include "files/loaded_frame.hpp"
#include "report/messages.hpp"

namespace dermis::program {

struct LoadedView {
  std::string path;
  LoadedFrame images;           ///< without depth
  std::vector<float> position;  ///< XYZ
  std::vector<float> normal;    ///< XYZ
  std::array<double, 12> to_camera;

  /// The images, for the library.
  View view() const;
};

/// Whether the light of a picture with these roles loses its view factor.
bool takes_out_view_factor(const SurfaceRequest& request, const exr::Roles& roles);

/// Loads the views of the request that belong to the picture of `frame`, which `camera` has seen and whose light is of
/// that kind. Throws Error(input_missing), Error(input_unsupported) or Error(role_missing) for what they lack, or for a
/// camera whose place in the world is not known.
std::vector<LoadedView> load_views(const SurfaceRequest& request, const FrameFile& frame,
                                   const exr::FoundCamera& camera, Lighting lighting);

/// An error of the library about "view N", of `views`, as one about --view.
Error view_named_by_file(const Error& error, const std::vector<LoadedView>& views);

/// Says how much of each view the camera does not see. Warns if that adds light to no pixel.
void report_views(const std::vector<LoadedView>& views, const Stats& stats, Messages& messages);

}  // namespace dermis::program
