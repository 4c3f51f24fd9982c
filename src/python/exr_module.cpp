// The module dermis._exr: pictures, roles and cameras for Python. dermis._core is loaded before it, whose Camera and
// Error it has.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dermis/error.hpp"
#include "dermis/exr.hpp"
#include "python/arrays.hpp"
#include "python/errors.hpp"

using namespace pybind11::literals;

namespace dermis::python {

namespace {

exr::Role role_of(const std::string& name) {
  for (const exr::RoleInfo& info : exr::role_table)
    if (info.name == name) return info.role;
  throw Error(ErrorCode::usage, "role", name, exr::role_names());
}

/// The values of a picture as an array; None if there are none.
py::object array_of(const exr::Picture& picture, const std::vector<float>& values) {
  const auto pixels = static_cast<std::size_t>(picture.width()) * static_cast<std::size_t>(picture.height());
  if (values.empty()) return py::none();
  std::vector<py::ssize_t> shape{picture.height(), picture.width()};
  if (values.size() > pixels) shape.push_back(static_cast<py::ssize_t>(values.size() / pixels));
  return py::array_t<float>(shape, values.data());
}

exr::Roles find_roles(const exr::Picture& picture, const std::vector<std::string>& overrides, const std::string& layer,
                      const std::string& view, const std::string& renderer) {
  exr::RoleRequest request{.overrides = overrides, .layer = layer, .view = view};
  if (!renderer.empty()) {
    request.renderer = exr::find_renderer(renderer);
    if (request.renderer == nullptr) throw Error(ErrorCode::usage, "renderer", renderer, exr::renderer_names());
  }
  return exr::find_roles(picture, request);
}

exr::FoundCamera find_camera(const exr::Picture& picture, const exr::Roles& roles, std::optional<double> fov_deg,
                             std::optional<double> focal_px, std::optional<double> orthographic_px_per_unit) {
  exr::CameraHint hint;
  hint.fov_deg = fov_deg;
  hint.focal_px = focal_px;
  hint.orthographic_px_per_unit = orthographic_px_per_unit;
  hint.name = fov_deg ? "fov_deg" : focal_px ? "focal_px" : "orthographic_px_per_unit";
  return exr::find_camera(picture, roles, hint);
}

/// The values of a channel come from an array of one value per pixel; the channel is added if it is not there.
void set_channel(exr::Picture& picture, const std::string& name, const py::object& values) {
  const ReadArray given = read_array(values, "values", picture.width(), picture.height(), 1);
  const auto packed = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(given.array);
  const std::vector<std::string> names{name};
  if (picture.find(name) == nullptr) picture.add_channels(names, Format::f32);
  picture.store(names, {packed.data(), static_cast<std::size_t>(packed.size())});
}

/// The images of a frame by the names that a plan has for them.
py::dict images_of(const exr::Picture& picture, const exr::Roles& roles, const exr::FoundCamera& camera) {
  py::dict images;
  using enum exr::Role;
  exr::require(picture, roles, light);
  for (const exr::Role role : {light, albedo, material, mask, matte, beauty})
    if (roles.has(role))
      images[py::str(std::string(name_of(role)))] = array_of(picture, exr::load(picture, roles, role));
  const std::vector<float> distances = exr::load_depth(picture, roles, camera);
  if (!distances.empty()) images["depth"] = array_of(picture, distances);
  return images;
}

void add_pictures(py::module_& m) {
  py::class_<exr::Roles>(m, "Roles")
      .def_readonly("layer", &exr::Roles::layer)
      .def_readonly("view", &exr::Roles::view)
      .def_readonly("renderer", &exr::Roles::renderer)
      .def_property_readonly("lighting", [](const exr::Roles& its) { return std::string(name_of(its.lighting)); })
      .def_readonly("warnings", &exr::Roles::warnings)
      .def("__contains__", [](const exr::Roles& its, const std::string& role) { return its.has(role_of(role)); })
      .def("__getitem__", [](const exr::Roles& its, const std::string& role) { return its[role_of(role)]; });
  py::class_<exr::FoundCamera>(m, "FoundCamera")
      .def_readonly("camera", &exr::FoundCamera::camera)
      .def_readonly("source", &exr::FoundCamera::source)
      .def_readonly("residual_units", &exr::FoundCamera::residual_units)
      .def_readonly("warnings", &exr::FoundCamera::warnings);
  py::class_<exr::Picture>(m, "Picture")
      .def_static(
          "read", [](const std::filesystem::path& path) { return exr::Picture::read(path); }, "path"_a)
      .def(py::init([](int width, int height) {
             if (width < 1 || height < 1)
               throw Error(ErrorCode::usage, "size", std::to_string(width) + "x" + std::to_string(height),
                           "1x1 or more");
             const exr::Window window{0, 0, width, height};
             return exr::Picture(window, window);
           }),
           "width"_a, "height"_a)
      .def_property_readonly("width", &exr::Picture::width)
      .def_property_readonly("height", &exr::Picture::height)
      .def_property_readonly("compression", &exr::Picture::compression)
      .def_property_readonly("channels",
                             [](const exr::Picture& its) {
                               std::vector<std::string> names;
                               for (const exr::Channel& channel : its.channels()) names.push_back(channel.name);
                               return names;
                             })
      .def("__contains__", [](const exr::Picture& its, const std::string& name) { return its.find(name) != nullptr; })
      .def("__getitem__",
           [](const exr::Picture& its, const std::string& name) { return array_of(its, its.plane(name)); })
      .def("__setitem__", &set_channel)
      .def("roles", &find_roles, "overrides"_a = std::vector<std::string>(), "layer"_a = "", "view"_a = "",
           "renderer"_a = "")
      .def(
          "load",
          [](const exr::Picture& its, const exr::Roles& roles, const std::string& role) {
            return array_of(its, exr::load(its, roles, role_of(role)));
          },
          "roles"_a, "role"_a)
      .def("camera", &find_camera, "roles"_a, "fov_deg"_a = py::none(), "focal_px"_a = py::none(),
           "orthographic_px_per_unit"_a = py::none())
      .def("images", &images_of, "roles"_a, "camera"_a)
      .def("attribute", &exr::Picture::text_attribute, "name"_a)
      .def("set_attribute", &exr::Picture::set_attribute, "name"_a, "value"_a)
      .def(
          "write",
          [](const exr::Picture& its, const std::filesystem::path& path, const std::string& compression,
             const std::vector<std::string>& channels) { its.write(path, compression, channels); },
          "path"_a, "compression"_a = "", "channels"_a = std::vector<std::string>());
}

}  // namespace

}  // namespace dermis::python

PYBIND11_MODULE(_exr, m) {
  using namespace dermis::python;
  raise_errors(py::module_::import("dermis._core").attr("Error"));
  add_pictures(m);
}
