#include "dermis/exr.hpp"
#include "measure/scene.hpp"

namespace dermis::bench {

Scene read_picture(const std::filesystem::path& path, double mm_per_unit, const std::vector<NamedMaterial>& materials) {
  const exr::Picture picture = exr::Picture::read(path);
  const exr::Roles roles = exr::find_roles(picture);
  for (const exr::Role role : {exr::Role::light, exr::Role::material}) exr::require(picture, roles, role);
  const exr::FoundCamera camera = exr::find_camera(picture, roles);
  Scene scene{.spec = {.geometry = Geometry::picture, .width = picture.width(), .height = picture.height()},
              .camera = camera.camera,
              .mm_per_unit = mm_per_unit,
              .layout = {.channel_stride = 4, .pixel_stride = 12, .row_stride = 12L * picture.width()},
              .light = exr::load(picture, roles, exr::Role::light),
              .depth = exr::load_depth(picture, roles, camera),
              .ids = exr::load(picture, roles, exr::Role::material),
              .materials = {},
              .name = path.stem().string()};
  for (const NamedMaterial& material : materials) {
    scene.materials.push_back({material.id, preset(material.preset).profile});
    scene.material_names.push_back(material.preset);
  }
  for (std::size_t pixel = 0; pixel < scene.pixels(); ++pixel) scene.covered += scene.material_of(pixel) ? 1 : 0;
  return scene;
}

}  // namespace dermis::bench
