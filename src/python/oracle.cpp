#include "python/oracle.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "dermis/oracle/materials.hpp"
#include "dermis/oracle/reference.hpp"
#include "dermis/oracle/scenes.hpp"
#include "python/arrays.hpp"
#include "python/plan_arguments.hpp"

using namespace pybind11::literals;

namespace dermis::python {

namespace {

using Filter = oracle::Reference (*)(const Frame&, std::span<const oracle::Material>, const Options&);

oracle::Reference exact(const Frame& frame, std::span<const oracle::Material> materials, const Options& options) {
  return oracle::surface_integral(frame, materials, options);
}

template <class Value>
py::array array_of(const std::vector<Value>& values, int width, int height, int channels) {
  std::vector<py::ssize_t> shape{height, width};
  if (channels > 1) shape.push_back(channels);
  return py::array_t<Value>(shape, values.data());
}

py::object array_of(const oracle::Picture& picture) {
  if (picture.values.empty()) return py::none();
  return array_of(picture.values, picture.width, picture.height, picture.channels);
}

template <Filter filter>
oracle::Reference run(const py::object& materials, const Camera& camera, double mm_per_unit, const py::dict& settings,
                      const py::kwargs& images) {
  const ReadFrame read = read_frame(camera, mm_per_unit, images);
  const Options options = options_of(settings);
  const auto its_materials = oracle::materials_of(materials_of(materials, {}), options.taps);
  const py::gil_scoped_release unlocked;
  return filter(read.frame, its_materials, options);
}

py::dict images_of(const oracle::Scene& scene) {
  const auto image = [&](const std::vector<float>& values, int channels) {
    return array_of(values, scene.width, scene.height, channels);
  };
  return py::dict("light"_a = image(scene.light, 3), "albedo"_a = image(scene.albedo, 3),
                  "depth"_a = image(scene.depth, 1), "material"_a = image(scene.material, 1),
                  "beauty"_a = image(scene.beauty, 3));
}

}  // namespace

void add_oracle(py::module_& m) {
  py::module_ module = m.def_submodule("oracle");
  py::class_<oracle::Reference> reference(module, "Reference");
  const auto picture = [&](const char* name, oracle::Picture oracle::Reference::*which) {
    reference.def_property_readonly(name, [which](const oracle::Reference& its) { return array_of(its.*which); });
  };
  picture("scattered", &oracle::Reference::scattered);
  picture("scattered_bound", &oracle::Reference::scattered_bound);
  picture("result", &oracle::Reference::result);
  picture("result_bound", &oracle::Reference::result_bound);
  const auto filter = [&](const char* name, auto function) {
    module.def(name, function, "materials"_a, "camera"_a, "mm_per_unit"_a = 1.0, "settings"_a = py::dict());
  };
  filter("separable", &run<oracle::separable>);
  filter("exact", &run<exact>);
  filter("disc", &run<oracle::disc>);

  py::class_<oracle::Scene>(module, "Scene")
      .def_readonly("camera", &oracle::Scene::camera)
      .def_property_readonly("images", &images_of);
  module.def(
      "scene",
      [](const std::string& name, int width, int height, double px_per_mm, bool orthographic) {
        return oracle::scene(name, width, height, px_per_mm,
                             orthographic ? Camera::Projection::orthographic : Camera::Projection::perspective);
      },
      "name"_a, "width"_a, "height"_a, "px_per_mm"_a = 4.0, "orthographic"_a = false);
  module.def("scenes", [] {
    py::dict all;
    for (const oracle::SceneInfo& its : oracle::scenes()) all[py::str(its.name)] = its.what;
    return all;
  });
}

}  // namespace dermis::python
