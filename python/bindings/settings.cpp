#include "python/bindings/settings.h"

#include <pybind11/pybind11.h>

#include "fovea/pipeline/config.h"

namespace fovea::python {
namespace py = pybind11;

MapperOptions mapper_options(const std::string& preset, const py::dict& settings) {
  MapperOptions options = load_preset(preset);
  // JSON's true, 1.5, "word" and [1, 2] are TOML's as well.
  const py::object dumps = py::module_::import("json").attr("dumps");
  for (const auto& [key, value] : settings) {
    apply_setting(py::cast<std::string>(key) + "=" + py::cast<std::string>(dumps(value)), options);
  }
  return options;
}

}  // namespace fovea::python
