// Keyword arguments as the mapper's options.
#pragma once

#include <pybind11/pytypes.h>

#include <string>

#include "fovea/pipeline/map_settings.h"

namespace fovea::python {

/// A preset with keys set, as by `fovea map --set`. ConfigError as there.
MapSettings map_settings(const std::string& preset, const pybind11::dict& settings);

}  // namespace fovea::python
