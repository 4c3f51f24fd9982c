#include "python/errors.hpp"

#include <exception>
#include <string>
#include <utility>

#include "dermis/error.hpp"

namespace py = pybind11;

namespace dermis::python {

namespace {

/// The type that this module raises. It lives as long as the interpreter.
PyObject* raised_type = nullptr;

}  // namespace

void raise_errors(py::object type) {
  raised_type = type.release().ptr();
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const Error& error) {
      py::object raised = py::reinterpret_borrow<py::object>(raised_type)(error.what());
      raised.attr("code") = static_cast<int>(error.code());
      raised.attr("argument") = std::string(error.argument());
      raised.attr("seen") = std::string(error.seen());
      raised.attr("wanted") = std::string(error.wanted());
      PyErr_SetObject(raised_type, raised.ptr());
    }
  });
}

void add_errors(py::module_& m) { raise_errors(py::exception<Error>(m, "Error", PyExc_RuntimeError)); }

}  // namespace dermis::python
