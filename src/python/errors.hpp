// dermis::Error as an exception of Python.
#pragma once

#include <pybind11/pybind11.h>

namespace dermis::python {

/// Adds the type Error to a module, and has this module raise it.
void add_errors(pybind11::module_& m);

/// Has a module raise that type of another one.
void raise_errors(pybind11::object type);

}  // namespace dermis::python
