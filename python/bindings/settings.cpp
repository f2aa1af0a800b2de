#include "python/bindings/settings.h"

#include <pybind11/pybind11.h>

#include "fovea/pipeline/config.h"

namespace fovea::python {
namespace py = pybind11;

MapSettings map_settings(const std::string& preset, const py::dict& settings) {
  MapSettings result = load_preset(preset);
  // JSON's true, 1.5, "word" and [1, 2] are TOML's as well.
  const py::object dumps = py::module_::import("json").attr("dumps");
  for (const auto& [key, value] : settings) {
    apply_setting(py::cast<std::string>(key) + "=" + py::cast<std::string>(dumps(value)), result);
  }
  return result;
}

}  // namespace fovea::python
