// Arrays of numpy as images, without copies where their layout allows.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <string>
#include <vector>

#include "dermis/frame.hpp"

namespace dermis::python {

namespace py = pybind11;

/// The values of an array, converted if the library does not know their type or layout.
struct ReadArray {
  py::array array;
  Layout layout;
};

/// Throws Error(usage) that names the array if it has another shape: (height, width) for one channel.
ReadArray read_array(const py::object& object, const char* name, int width, int height, int channels);

/// An array to write, which is made if the caller has none. Throws Error(usage) for one that cannot be written.
ReadArray written_array(const py::object& object, const char* name, int width, int height);

/// An image of a frame that may be read, by its name.
struct ImageSlot {
  const char* name;
  int channels;
  Image Frame::*image;
};

/// Throws Error(usage) that lists the names if there is no such image.
const ImageSlot& slot_of(const std::string& name);

/// A frame without outputs, and the arrays that its images lie in.
struct ReadFrame {
  Frame frame;
  std::vector<ReadArray> held;
};

/// The size is that of the light. Throws as read_array, and Error(role_missing) without light.
ReadFrame read_frame(const Camera& camera, double mm_per_unit, const py::dict& images);

}  // namespace dermis::python
