#include "python/arrays.hpp"

#include <cstddef>
#include <optional>

#include "dermis/error.hpp"

namespace dermis::python {

namespace {

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

constexpr std::array slots = {ImageSlot{"light", 3, &Frame::light},   ImageSlot{"albedo", 3, &Frame::albedo},
                              ImageSlot{"depth", 1, &Frame::depth},   ImageSlot{"material", 1, &Frame::material},
                              ImageSlot{"mask", 1, &Frame::mask},     ImageSlot{"matte", 1, &Frame::matte},
                              ImageSlot{"normal", 3, &Frame::normal}, ImageSlot{"beauty", 3, &Frame::beauty}};

}  // namespace

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

const ImageSlot& slot_of(const std::string& name) {
  std::string names;
  for (const ImageSlot& slot : slots) {
    if (name == slot.name) return slot;
    names += (names.empty() ? "" : ", ") + std::string(slot.name);
  }
  throw Error(ErrorCode::usage, "image", name, names);
}

ReadFrame read_frame(const Camera& camera, double mm_per_unit, const py::dict& images) {
  if (!images.contains("light")) throw Error(ErrorCode::role_missing, "light", "no image", "an image");
  const py::array light = py::array::ensure(images["light"]);
  if (!light || light.ndim() != 3) throw Error(ErrorCode::usage, "light", "another shape", "(height, width, 3)");
  ReadFrame read{{.width = static_cast<int>(light.shape(1)),
                  .height = static_cast<int>(light.shape(0)),
                  .camera = camera,
                  .mm_per_unit = mm_per_unit},
                 {}};
  Frame& frame = read.frame;
  std::vector<ReadArray>& held = read.held;
  for (const auto& [key, value] : images) {
    if (value.is_none()) continue;
    const ImageSlot& slot = slot_of(py::str(key).cast<std::string>());
    held.push_back(
        read_array(py::reinterpret_borrow<py::object>(value), slot.name, frame.width, frame.height, slot.channels));
    frame.*slot.image = {.host = held.back().array.data(), .layout = held.back().layout};
  }
  return read;
}

}  // namespace dermis::python
