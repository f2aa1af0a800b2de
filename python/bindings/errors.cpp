// Fovea's errors as Python's exceptions of the same names.
#include "fovea/errors.h"

#include "python/bindings/bindings.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

/// Text that may quote a file's name in any encoding, decoded as Python decodes names.
py::object text_object(const std::string& text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size())));
}

/// Sets the Python error of a class of fovea/errors.py.
void set_error(const char* name, const Error& error) {
  const py::object type = py::module_::import("fovea.errors").attr(name);
  const py::object exception = type(text_object(error.what()));
  exception.attr("problem") = text_object(error.problem());
  exception.attr("where") = text_object(error.where());
  exception.attr("remedy") = text_object(error.remedy());
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const InputError& error) {
      set_error("InputError", error);
    } catch (const ConfigError& error) {
      set_error("ConfigError", error);
    } catch (const OutputError& error) {
      set_error("OutputError", error);
    } catch (const Error& error) {
      set_error("Error", error);
    }
  });
}

}  // namespace fovea::python
