/// The images of a picture that the filter reads, in memory as float.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "arguments/cryptomatte_argument.hpp"
#include "arguments/material_arguments.hpp"
#include "dermis/exr.hpp"
#include "dermis/frame.hpp"
#include "dermis/plan.hpp"

namespace dermis::program {

/// A view of packed values; no image if there are none.
inline Image image_of(const std::vector<float>& values) { return {.host = values.empty() ? nullptr : values.data()}; }

struct LoadedFrame {
  int width = 0;
  int height = 0;
  std::vector<float> light;   ///< RGB
  std::vector<float> albedo;  ///< RGB, or empty
  std::vector<float> depth;
  std::vector<float> material;  ///< or empty
  std::vector<float> mask;      ///< or empty
  std::vector<float> matte;     ///< or empty
  std::vector<float> normal;    ///< XYZ, on the axes of the camera, or empty
  std::string cryptomatte;      ///< the one that material and matte are from, or empty

  /// Views of these images, and nothing else of a frame.
  Frame frame() const;
};

/// 1 for the pixels that scatter, 0 for the others: those of background, of no material, or with nothing of it.
std::vector<std::uint8_t> scattering_pixels(const LoadedFrame& loaded, const std::vector<NamedProfile>& profiles);

/// The light as the filter writes it where nothing scatters: without the albedo, but for what --albedo-mix puts in.
std::vector<float> scattering_light(const LoadedFrame& loaded, Lighting lighting, double albedo_mix);

/// Throws Error(role_missing) if the picture lacks a role that these profiles need. `has_cryptomatte`: ids come from
/// there.
void require_roles(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                   bool has_cryptomatte = false);

/// The roles that the picture has but for depth; ids only if the profiles tell materials apart, from a Cryptomatte if
/// there are `mattes`; its manifest may lie in `folder`. Throws Error(input_unsupported) if a role has the wrong number
/// of channels.
LoadedFrame load_images(const exr::Picture& picture, const exr::Roles& roles, const std::vector<NamedProfile>& profiles,
                        const std::vector<MatteId>& mattes, const std::filesystem::path& folder);

/// The depth of the picture, or that of its positions if it has no other. Throws as load_images.
std::vector<float> load_depth_image(const exr::Picture& picture, const exr::Roles& roles,
                                    const exr::FoundCamera& camera);

/// Whether the surface of such a material does something to the light that enters by its curvature.
bool any_walk(const std::vector<NamedProfile>& profiles);

/// The normals of the picture on the axes of the camera; none if it has none, or if it is not known where the camera
/// is.
std::vector<float> load_normal_image(const exr::Picture& picture, const exr::Roles& roles,
                                     const exr::FoundCamera& camera);

/// What is known of the depth without a camera: that of the picture, or infinite where there is no position, and 1
/// elsewhere.
std::vector<float> load_depth_image(const exr::Picture& picture, const exr::Roles& roles);

}  // namespace dermis::program
