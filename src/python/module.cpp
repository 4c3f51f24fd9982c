// dermis for Python: numpy arrays in and out, without copies where their layout allows.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/dermis.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace dermis::python {

namespace {

/// The values of an array, converted if the library does not know their type or layout.
struct ReadArray {
  py::array array;
  Layout layout;
};

std::optional<Format> format_of(const py::dtype& type) {
  const auto size = type.itemsize();
  if (type.byteorder() == '>') return std::nullopt;
  if (type.kind() == 'f' && size == 2) return Format::f16;
  if (type.kind() == 'f' && size == 4) return Format::f32;
  if (type.kind() == 'u' && size == 1) return Format::u8;
  if (type.kind() == 'u' && size == 2) return Format::u16;
  if (type.kind() == 'u' && size == 4) return Format::u32;
  return std::nullopt;
}

std::string shape_text(const py::array& array) {
  std::string text = "an array of shape (";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + ")";
}

void check_shape(const py::array& array, const char* name, int width, int height, int channels) {
  const bool is_right = array.ndim() == (channels == 1 ? 2 : 3) && array.shape(0) == height &&
                        array.shape(1) == width && (channels == 1 || array.shape(2) == channels);
  if (is_right) return;
  const std::string size = "(" + std::to_string(height) + ", " + std::to_string(width);
  throw Error(ErrorCode::usage, name, shape_text(array),
              size + (channels == 1 ? ")" : ", " + std::to_string(channels) + ")"));
}

/// A stride of 0 is a packed one for the library, and several values in one place for numpy.
bool repeats_values(const py::array& array) {
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    if (array.strides(i) == 0) return true;
  }
  return false;
}

Layout layout_of(const py::array& array, Format format) {
  return {.format = format,
          .channel_stride = array.ndim() == 3 ? array.strides(2) : static_cast<std::ptrdiff_t>(bytes_of(format)),
          .pixel_stride = array.strides(1),
          .row_stride = array.strides(0)};
}

ReadArray read_array(const py::object& object, const char* name, int width, int height, int channels) {
  py::array array = py::array::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw Error(ErrorCode::usage, name, "something else", "an array of numbers");
  }
  check_shape(array, name, width, height, channels);
  std::optional<Format> format = format_of(array.dtype());
  if (!format || repeats_values(array)) {
    array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!array) {
      PyErr_Clear();
      throw Error(ErrorCode::usage, name, "values of another kind", "numbers");
    }
    format = Format::f32;
  }
  return {array, layout_of(array, *format)};
}

/// An array to write, which is made if the caller has none.
ReadArray written_array(const py::object& object, const char* name, int width, int height) {
  if (object.is_none()) {
    py::array array = py::array_t<float>({height, width, 3});
    return {array, layout_of(array, Format::f32)};
  }
  if (!py::isinstance<py::array>(object)) throw Error(ErrorCode::usage, name, "something else", "an array or None");
  auto array = py::reinterpret_borrow<py::array>(object);
  check_shape(array, name, width, height, 3);
  const std::optional<Format> format = format_of(array.dtype());
  if (!array.writeable() || repeats_values(array) || !format || (format != Format::f16 && format != Format::f32)) {
    throw Error(ErrorCode::usage, name, "an array that cannot be written so", "one of float16 or float32, writeable");
  }
  return {array, layout_of(array, *format)};
}

/// A profile, or one as text.
Profile profile_of(const py::handle& profile) {
  if (py::isinstance<py::str>(profile)) return parse_profile("profile", profile.cast<std::string>());
  if (py::isinstance<Profile>(profile)) return profile.cast<Profile>();
  throw Error(ErrorCode::usage, "profile", "something else", "a Profile, or one as text");
}

/// A setting's value as text.
std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "on" : "off";
  if (value.is_none()) return "none";
  return py::str(value);
}

Options options_of(const py::dict& settings) {
  Options options;
  for (const auto& [name, value] : settings) set(options, py::str(name).cast<std::string>(), text_of(value));
  return options;
}

std::vector<Material> materials_of(const py::object& materials, const std::map<int, double>& pixel_mm) {
  std::vector<Material> result;
  const auto add = [&](int id, const py::handle& profile) {
    const auto size = pixel_mm.find(id);
    result.push_back({.id = id, .profile = profile_of(profile), .pixel_mm = size == pixel_mm.end() ? 0 : size->second});
  };
  if (py::isinstance<py::dict>(materials)) {
    for (const auto& [id, profile] : materials.cast<py::dict>()) add(id.cast<int>(), profile);
  } else {
    add(0, materials);
  }
  return result;
}

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

struct ImageSlot {
  const char* name;
  int channels;
  Image Frame::*image;
};

constexpr std::array slots = {ImageSlot{"light", 3, &Frame::light},   ImageSlot{"albedo", 3, &Frame::albedo},
                              ImageSlot{"depth", 1, &Frame::depth},   ImageSlot{"material", 1, &Frame::material},
                              ImageSlot{"mask", 1, &Frame::mask},     ImageSlot{"matte", 1, &Frame::matte},
                              ImageSlot{"normal", 3, &Frame::normal}, ImageSlot{"beauty", 3, &Frame::beauty}};

const ImageSlot& slot_of(const std::string& name) {
  std::string names;
  for (const ImageSlot& slot : slots) {
    if (name == slot.name) return slot;
    names += (names.empty() ? "" : ", ") + std::string(slot.name);
  }
  throw Error(ErrorCode::usage, "image", name, names);
}

FrameDescription description_of(const std::vector<std::string>& images) {
  Frame frame;
  static const char there = 0;
  for (const std::string& name : images) frame.*slot_of(name).image = {.host = &there};
  return FrameDescription::of(frame);
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
  if (!images.contains("light")) throw Error(ErrorCode::role_missing, "light", "no image", "an image");
  const py::array light = py::array::ensure(images["light"]);
  if (!light || light.ndim() != 3) throw Error(ErrorCode::usage, "light", "another shape", "(height, width, 3)");
  Frame frame{.width = static_cast<int>(light.shape(1)),
              .height = static_cast<int>(light.shape(0)),
              .camera = camera,
              .mm_per_unit = mm_per_unit};
  std::vector<ReadArray> held;
  for (const auto& [key, value] : images) {
    if (value.is_none()) continue;
    const ImageSlot& slot = slot_of(py::str(key).cast<std::string>());
    held.push_back(
        read_array(py::reinterpret_borrow<py::object>(value), slot.name, frame.width, frame.height, slot.channels));
    frame.*slot.image = {.host = held.back().array.data(), .layout = held.back().layout};
  }
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

void add_errors(py::module_& m) {
  static py::exception<Error> type(m, "Error", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const Error& error) {
      py::object raised = static_cast<const py::object&>(type)(error.what());
      raised.attr("code") = static_cast<int>(error.code());
      raised.attr("argument") = std::string(error.argument());
      raised.attr("seen") = std::string(error.seen());
      raised.attr("wanted") = std::string(error.wanted());
      PyErr_SetObject(type.ptr(), raised.ptr());
    }
  });
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
}
