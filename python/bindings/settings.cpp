#include "python/bindings/settings.h"

#include <pybind11/pybind11.h>

namespace fovea::python {
namespace py = pybind11;

MapperSettings mapper_settings(const std::string& preset, const py::dict& settings) {
  MapperSettings result{preset, {}};
  // JSON's true, 1.5, "word" and [1, 2] are TOML's as well.
  const py::object dumps = py::module_::import("json").attr("dumps");
  for (const auto& [key, value] : settings) {
    result.values[py::cast<std::string>(key)] = py::cast<std::string>(dumps(value));
  }
  return result;
}

}  // namespace fovea::python
