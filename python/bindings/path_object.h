// Paths as Python's text.
#pragma once

#include <pybind11/stl/filesystem.h>

#include <filesystem>

namespace fovea::python {

/// What __fspath__ returns: the name in any encoding, as Python decodes names.
inline pybind11::object name_object(const std::filesystem::path& path) {
  return pybind11::module_::import("os").attr("fspath")(path);
}

}  // namespace fovea::python
