/// The part of a picture that is read before anything is computed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arguments/surface_arguments.hpp"
#include "dermis/exr.hpp"
#include "dermis/plan.hpp"
#include "dermis/translucency.hpp"
#include "files/frame_names.hpp"
#include "files/loaded_frame.hpp"
#include "files/loaded_view.hpp"
#include "report/messages.hpp"

namespace dermis::program {

/// The images that light that comes through needs beside those of the filter, in memory as float.
struct TranslucencyImages {
  std::vector<float> position;   ///< XYZ
  std::vector<float> normal;     ///< XYZ
  std::vector<float> thickness;  ///< or empty
};

/// One view of a picture.
struct SurfaceInput {
  exr::Picture& picture;
  exr::Roles roles;
  Lighting lighting;
  exr::FoundCamera camera;
  LoadedFrame loaded;
  std::optional<TranslucencyImages> translucency;
  std::vector<float> view_factors;  ///< taken out of the light of each pixel; or empty
  std::vector<LoadedView> loaded_views;
  std::vector<View> views;  ///< of the images in loaded_views
  bool scatters = true;     ///< any pixel; if none does there may be no camera

  /// A view of the images, with the camera and nothing to write.
  Frame frame(double mm_per_unit) const;
};

/// Reads the file, with room for the scattered light of a view.
exr::Picture read_picture(const std::string& path);

/// Loads what is needed of a view of a picture, which is that of `frame`. Throws Error(input_missing),
/// Error(input_unsupported) or Error(role_missing) for what it lacks.
SurfaceInput load_surface(exr::Picture& picture, const FrameFile& frame, const std::string& view,
                          const SurfaceRequest& request, bool needs_beauty);

/// The pictures that load_surface reads for a frame. Throws as role_texts.
std::vector<std::string> pictures_read(const SurfaceRequest& request, const FrameFile& frame);

/// The pixels of a material. Sizes are along the axis that has the smaller ones; none if no pixel is of the material.
struct MaterialPixels {
  std::int64_t pixels = 0;
  std::optional<double> pixel_mm;         ///< at the median depth
  std::optional<double> finest_pixel_mm;  ///< at the nearest depth
};

/// Counts the pixels of each profile. Warns of a material that no pixel has.
std::vector<MaterialPixels> count_pixels(const SurfaceInput& input, const SurfaceRequest& request, Messages& messages);

/// Throws Error(role_missing) that names the materials if nothing in the picture scatters.
void require_scattering(const SurfaceInput& input, const SurfaceRequest& request);

/// Adds the light that comes through, if it was asked for, to that of the input, which `frame` views.
void transmit_light(const Device& device, const SurfaceRequest& request, const Frame& frame, SurfaceInput& input);

}  // namespace dermis::program
