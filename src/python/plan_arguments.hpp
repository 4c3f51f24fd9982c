// What a plan is made of, as Python says it.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>
#include <vector>

#include "dermis/plan.hpp"

namespace dermis::python {

namespace py = pybind11;

/// A profile, or one as text.
Profile profile_of(const py::handle& profile);

Options options_of(const py::dict& settings);

/// A profile for every pixel, or profiles by id; `pixel_mm` is by id, too.
std::vector<Material> materials_of(const py::object& materials, const std::map<int, double>& pixel_mm);

/// Frames with light and these images.
FrameDescription description_of(const std::vector<std::string>& images);

}  // namespace dermis::python
