// The module dermis._core: devices, profiles, taps and plans for Python, and the oracle.
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dermis/dermis.hpp"
#include "python/arrays.hpp"
#include "python/errors.hpp"
#include "python/oracle.hpp"
#include "python/plan_arguments.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace dermis::python {

namespace {

/// f(channel, x) of each x, as an array with a channel in its last axis.
template <class Function>
py::array_t<double> of_each(const py::array_t<double, py::array::c_style | py::array::forcecast>& x,
                            const Function& f) {
  std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
  shape.push_back(3);
  py::array_t<double> result(shape);
  const double* from = x.data();
  double* to = result.mutable_data();
  for (py::ssize_t i = 0; i < x.size(); ++i) {
    for (int c = 0; c < 3; ++c) *to++ = f(c, from[i]);
  }
  return result;
}

py::dict dict_of(const Stats& stats) {
  return py::dict("prepare_ms"_a = stats.prepare_ms, "classify_ms"_a = stats.classify_ms,
                  "scatter_ms"_a = stats.scatter_ms, "finish_ms"_a = stats.finish_ms, "total_ms"_a = stats.total_ms,
                  "bands"_a = stats.bands, "pixels"_a = stats.pixels, "pixels_scattered"_a = stats.pixels_scattered,
                  "pixels_without_material"_a = stats.pixels_without_material, "pixels_narrow"_a = stats.pixels_narrow,
                  "pixels_bad"_a = stats.pixels_bad);
}

struct Result {
  py::object scattered, result;
  py::dict stats;
};

Result run(const Plan& plan, const Camera& camera, double mm_per_unit, const py::object& scattered,
           const py::object& result, const py::object& progress, const py::kwargs& images) {
  const ReadFrame read = read_frame(camera, mm_per_unit, images);
  Frame frame = read.frame;
  Result out;
  ReadArray to = written_array(scattered, "scattered", frame.width, frame.height);
  frame.scattered = {.host = to.array.mutable_data(), .layout = to.layout};
  out.scattered = to.array;
  out.result = py::none();
  if (frame.beauty) {
    ReadArray beauty = written_array(result, "result", frame.width, frame.height);
    frame.result = {.host = beauty.array.mutable_data(), .layout = beauty.layout};
    out.result = beauty.array;
  } else if (!result.is_none()) {
    throw Error(ErrorCode::role_missing, "beauty", "no image", "an image, for a result");
  }
  Progress report;
  if (!progress.is_none()) {
    report = [&](double share) {
      const py::gil_scoped_acquire locked;
      const py::object answer = progress(share);
      return answer.is_none() || answer.cast<bool>();
    };
  }
  Stats stats;
  {
    const py::gil_scoped_release unlocked;
    stats = plan.run(frame, report);
  }
  out.stats = dict_of(stats);
  return out;
}

void add_devices(py::module_& m) {
  py::class_<DeviceInfo>(m, "DeviceInfo")
      .def_readonly("name", &DeviceInfo::name)
      .def_readonly("platform", &DeviceInfo::platform)
      .def_readonly("driver", &DeviceInfo::driver)
      .def_readonly("type", &DeviceInfo::type)
      .def_readonly("compute_units", &DeviceInfo::compute_units)
      .def_readonly("memory_bytes", &DeviceInfo::memory_bytes)
      .def("__repr__", [](const DeviceInfo& info) { return "<dermis.DeviceInfo " + info.name + ">"; });
  py::class_<Device>(m, "Device")
      .def(py::init([](const std::string& name, int threads) { return Device::open(name, threads); }), "name"_a = "",
           "threads"_a = 0)
      .def_property_readonly("info", &Device::info);
  m.def("devices", &Device::list);
}

void add_profiles(py::module_& m) {
  using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
  py::class_<Profile>(m, "Profile")
      .def(py::init([](const std::string& text) { return parse_profile("profile", text); }), "text"_a)
      .def(
          "radial",
          [](const Profile& its, const Numbers& r_mm) {
            return of_each(r_mm, [&](int c, double r) { return its.radial(c, r); });
          },
          "r_mm"_a)
      .def(
          "marginal",
          [](const Profile& its, const Numbers& x_mm) {
            return of_each(x_mm, [&](int c, double x) { return its.marginal(c, x); });
          },
          "x_mm"_a)
      .def(
          "edge",
          [](const Profile& its, const Numbers& x_mm) {
            return of_each(x_mm, [&](int c, double x) { return its.edge(c, x); });
          },
          "x_mm"_a)
      .def(
          "cdf",
          [](const Profile& its, const Numbers& r_mm) {
            return of_each(r_mm, [&](int c, double r) { return its.cdf(c, r); });
          },
          "r_mm"_a)
      .def(
          "radius",
          [](const Profile& its, const Numbers& share) {
            return of_each(share, [&](int c, double s) { return its.radius(c, s); });
          },
          "share"_a)
      .def(
          "transmittance",
          [](const Profile& its, const Numbers& thickness_mm) {
            return of_each(thickness_mm, [&](int c, double s) { return its.transmittance(c, s); });
          },
          "thickness_mm"_a)
      .def("__eq__", [](const Profile& a, const Profile& b) { return a == b; });
  m.def("presets", [] {
    py::dict all;
    for (const Preset& preset : presets()) all[py::str(preset.name)] = preset.source;
    return all;
  });
}

void add_taps(py::module_& m) {
  py::class_<TapSet>(m, "Taps")
      .def(py::init([](const py::object& profile, double pixel_mm, const py::kwargs& settings) {
             return make_tap_set(profile_of(profile), options_of(settings).taps, pixel_mm);
           }),
           "profile"_a, "pixel_mm"_a)
      .def_readonly("pixel_mm", &TapSet::pixel_mm)
      .def_readonly("predicted_rel_l2", &TapSet::predicted_rel_l2)
      .def_property_readonly("offsets_px",
                             [](const TapSet& its) {
                               return py::array_t<double>(static_cast<py::ssize_t>(its.offsets_px.size()),
                                                          its.offsets_px.data());
                             })
      .def_property_readonly("scales",
                             [](const TapSet& its) {
                               py::array_t<double> scales({static_cast<py::ssize_t>(its.terms.size()), py::ssize_t{3}});
                               double* to = scales.mutable_data();
                               for (const TapTerm& term : its.terms)
                                 to = std::copy(term.scale.begin(), term.scale.end(), to);
                               return scales;
                             })
      .def_property_readonly("weights", [](const TapSet& its) {
        py::array_t<float> weights({static_cast<py::ssize_t>(its.terms.size()),
                                    static_cast<py::ssize_t>(its.offsets_px.size()), py::ssize_t{3}});
        float* to = weights.mutable_data();
        for (const TapTerm& term : its.terms) {
          for (const auto& weight : term.weights) to = std::copy(weight.begin(), weight.end(), to);
        }
        return weights;
      });
}

void add_plans(py::module_& m) {
  py::class_<Camera>(m, "Camera")
      .def_static("perspective", &Camera::perspective, "focal_x_px"_a, "focal_y_px"_a, "center_x_px"_a, "center_y_px"_a)
      .def_static("orthographic", &Camera::orthographic, "px_per_unit_x"_a, "px_per_unit_y"_a)
      .def_readonly("scale_x", &Camera::scale_x)
      .def_readonly("scale_y", &Camera::scale_y)
      .def_readonly("center_x", &Camera::center_x)
      .def_readonly("center_y", &Camera::center_y)
      .def("__eq__", [](const Camera& a, const Camera& b) { return a == b; });
  py::class_<Result>(m, "Result")
      .def_readonly("scattered", &Result::scattered)
      .def_readonly("result", &Result::result)
      .def_readonly("stats", &Result::stats);
  py::class_<Plan>(m, "Plan")
      .def(py::init([](const py::object& materials, const std::vector<std::string>& images,
                       const std::optional<Device>& device, const std::map<int, double>& pixel_mm,
                       const py::kwargs& settings) {
             const std::vector<Material> its_materials = materials_of(materials, pixel_mm);
             const Options options = options_of(settings);
             const FrameDescription frames = description_of(images);
             const py::gil_scoped_release unlocked;
             return Plan(device ? *device : Device::open(), its_materials, frames, options);
           }),
           "materials"_a, "images"_a, "device"_a = py::none(), "pixel_mm"_a = std::map<int, double>())
      .def("run", &run, "camera"_a, "mm_per_unit"_a = 1.0, py::kw_only(), "scattered"_a = py::none(),
           "result"_a = py::none(), "progress"_a = py::none())
      .def("scratch_bytes", py::overload_cast<int, int>(&Plan::scratch_bytes, py::const_), "width"_a, "height"_a);
  m.def("settings", [] {
    py::dict all;
    for (const Setting& setting : settings()) all[setting.name] = setting.help;
    return all;
  });
}

}  // namespace

}  // namespace dermis::python

PYBIND11_MODULE(_core, m) {
  using namespace dermis::python;
  m.attr("__version__") = DERMIS_VERSION;
  add_errors(m);
  add_devices(m);
  add_profiles(m);
  add_taps(m);
  add_plans(m);
  add_oracle(m);
}
