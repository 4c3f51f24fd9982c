// The scalar filter in double precision, for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace dermis::python {

/// Adds the module `oracle`.
void add_oracle(pybind11::module_& m);

}  // namespace dermis::python
