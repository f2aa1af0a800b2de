// Keyword arguments as the mapper's settings.
#pragma once

#include <pybind11/pytypes.h>

#include <string>

#include "fovea/mapper.h"

namespace fovea::python {

/// A preset with keys set, as by `fovea map --set`.
MapperSettings mapper_settings(const std::string& preset, const pybind11::dict& settings);

}  // namespace fovea::python
