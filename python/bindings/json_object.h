// JSON text as Python's dicts and lists.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace fovea::python {

inline pybind11::object json_object(const std::string& text) {
  return pybind11::module_::import("json").attr("loads")(text);
}

}  // namespace fovea::python
